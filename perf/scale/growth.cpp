// growth.cpp  Time and memory over the number of instances, of vertices, and one or two workers.
#include "perf/scale/crowd.hpp"
#include "perf/scale/groups.hpp"
#include "perf/scale/pinned_pair.hpp"
#include "perf/scale/record.hpp"
#include "perf/scale/stopwatch.hpp"

namespace sinew::perf {
namespace {

constexpr unsigned kCounts[] = {1, 2, 5, 10, 20, 50, 100, 200, 500};
constexpr int kWarmFrames = 40;

void put_memory(const Case& of, const Crowd& crowd) {
  put(of, "state_bytes", static_cast<double>(crowd.state_bytes()));
  put(of, "instance_bytes", static_cast<double>(crowd.info().instance_bytes));
}

void put_times(const Case& of, const Lap& lap) {
  put(of, "wall_us", median(lap.wall_us));
  put(of, "cpu_us", median(lap.cpu_us));
}

}  // namespace

void measure_vertices(const std::vector<demo::CharacterFile>& characters, int rounds) {
  std::vector<Crowd> crowds;
  for (const demo::CharacterFile& character : characters) crowds.emplace_back(character, 1);
  for (int frame = 0; frame < kWarmFrames; ++frame) {
    for (Crowd& crowd : crowds) crowd.pose(), crowd.step();
  }
  std::vector<Lap> steps, reads;
  for (Crowd& crowd : crowds) {
    steps.push_back({"step", 20, [&crowd] { crowd.step(); }});
    reads.push_back({"read", 5, [&crowd] { crowd.read(0, Space::kCharacter); }});
  }
  run_laps(steps, rounds);
  run_laps(reads, rounds);
  for (size_t i = 0; i < crowds.size(); ++i) {
    const Case of{"vertices", "step", crowds[i].info().vertex_count, 1, 1};
    put_times(of, steps[i]);
    put(of, "read_us", median(reads[i].cpu_us));
    put_memory(of, crowds[i]);
  }
}

void measure_crowds(const demo::CharacterFile& character, int rounds) {
  const PinnedPair pair;
  for (const unsigned count : kCounts) {
    Crowd serial(character, count), shared(character, count, "", pair.hook());
    std::vector<Lap> laps = {{"1", 1, [&] { serial.step(); }}, {"2", 1, [&] { shared.step(); }}};
    const int frames = count > 100 ? kWarmFrames / 4 : kWarmFrames;
    for (int frame = 0; frame < frames; ++frame) serial.pose(), serial.step(), shared.pose(), shared.step();
    for (int round = 0; round < rounds; ++round) {
      serial.pose(), shared.pose();
      for (Lap& lap : laps) run_lap(lap);
    }
    for (unsigned workers = 1; workers <= 2; ++workers) {
      const Case of{"instances", "step", serial.info().vertex_count, count, workers};
      put_times(of, laps[workers - 1]);
      if (workers == 1) put_memory(of, serial);
    }
  }
}

}  // namespace sinew::perf

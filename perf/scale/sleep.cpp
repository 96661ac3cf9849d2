// sleep.cpp  What sleeping regions save on clips, and what they cost in error.
#include <cmath>

#include "perf/scale/crowd.hpp"
#include "perf/scale/groups.hpp"
#include "perf/scale/record.hpp"
#include "perf/scale/stopwatch.hpp"

namespace sinew::perf {
namespace {

constexpr int kTicks = 900, kMovingTicks = 90;

// Distances of the soft vertices in two surfaces, added up.
class Distances {
 public:
  explicit Distances(std::vector<uint32_t> soft) : soft_(std::move(soft)) {}
  void add(const std::vector<float>& a, const std::vector<float>& b) {
    for (const uint32_t v : soft_) {
      const size_t i = size_t{3} * v;
      const double distance = std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]);
      sum_ += distance;
      largest_ = std::max(largest_, distance);
    }
    count_ += static_cast<double>(soft_.size());
  }
  double mean_mm() const { return 1000 * sum_ / count_; }
  double largest_mm() const { return 1000 * largest_; }

 private:
  std::vector<uint32_t> soft_;
  double sum_ = 0, largest_ = 0, count_ = 0;
};

// `stands`: the clip is held after kMovingTicks.
void measure_clip(const demo::CharacterFile& character, const std::string& clip, bool stands,
                  float tolerance) {
  Crowd sleeper(character, 1, clip, {}, tolerance), waker(character, 1, clip, {}, 0);
  double asleep = 0;
  Lap with{"sleeper", 1, [&] { asleep += sleeper.step().regions_asleep; }};
  Lap without{"waker", 1, [&] { waker.step(); }};
  Distances distances(demo::soft_vertices(character));
  for (int tick = 0; tick < kTicks; ++tick) {
    if (tick < kMovingTicks || !stands) sleeper.pose(), waker.pose();
    tick % 2 == 0 ? (run_lap(with), run_lap(without)) : (run_lap(without), run_lap(with));
    sleeper.read(0, Space::kCharacter), waker.read(0, Space::kCharacter);
    distances.add(sleeper.surface(), waker.surface());
  }
  char name[64];
  std::snprintf(name, sizeof name, "%s%s; tolerance %g", clip.c_str(), stands ? " then still" : "",
                static_cast<double>(tolerance));
  const Case of{"sleep", name, sleeper.info().vertex_count, 1, 1};
  put(of, "share_asleep", asleep / kTicks / sleeper.info().region_count);
  put(of, "time_ratio", mean(with.cpu_us) / mean(without.cpu_us));
  put(of, "added_error_mean_mm", distances.mean_mm());
  put(of, "added_error_largest_mm", distances.largest_mm());
}

}  // namespace

void measure_sleep(const demo::CharacterFile& character) {
  constexpr float kUsual = WorldDef{}.sleep_tolerance;
  for (const float tolerance : {kUsual / 4, kUsual, kUsual * 4}) {
    for (const char* clip : {"idle", "hop"}) measure_clip(character, clip, false, tolerance);
    measure_clip(character, "hop", true, tolerance);
  }
}

}  // namespace sinew::perf

// workers.cpp  One large network on one and on two workers, beside what two workers can do at all; and
// several characters' control graphs as one network.
#include "core/floating_point.hpp"
#include "core/run_tasks.hpp"
#include "perf/kernels/bench_data.hpp"
#include "perf/kernels/fma_peak.hpp"
#include "perf/scale/groups.hpp"
#include "perf/scale/pinned_pair.hpp"
#include "perf/scale/record.hpp"
#include "perf/scale/stopwatch.hpp"

namespace sinew::perf {
namespace {

// A network at work: state, scratch and inputs.
class Running {
 public:
  Running(const tissue::Network& network, const tissue::Graph& graph)
      : network_(network),
        graph_(graph),
        state_(tissue::state_floats(network, graph.node_count)),
        scratch_(tissue::shared_scratch_floats(network, graph.node_count)),
        z_(random_floats(simd::pad_to_block(network.record->input_width) * graph.node_count, 0.1f)) {}

  void step() { tissue::network_step(network_, graph_, z_.data(), nullptr, state_.data(), scratch_.data()); }
  void step_on(const TaskHook& tasks) {
    tissue::network_step_on_workers(tasks, network_, graph_, z_.data(), nullptr, state_.data(),
                                    scratch_.data());
  }

 private:
  tissue::Network network_;
  tissue::Graph graph_;
  Floats state_, scratch_, z_;
};

// The peak's loop in as many tasks as a layer of the network.
void run_peak(void*, uint32_t) {
  float sink = 0;
  run_fma(100'000, &sink);
  benchmark::DoNotOptimize(sink);
}

}  // namespace

void measure_workers(int rounds) {
  const core::FloatingPointScope mode;
  const PinnedPair pair;
  const TorusGraph graph(106, 65);
  RandomNetwork paper(paper_shape());
  Running network(paper.view(), graph.view());
  constexpr uint32_t kShares = tissue::kNetworkShares;
  std::vector<Lap> laps = {
      {"peak on 1", 1, [&] { core::run_tasks({}, run_peak, nullptr, kShares); }},
      {"peak on 2", 1, [&] { core::run_tasks(pair.hook(), run_peak, nullptr, kShares); }},
      {"network on 1", 1, [&] { network.step(); }},
      {"network on 2", 1, [&] { network.step_on(pair.hook()); }},
  };
  run_laps(laps, rounds);
  const auto report = [&](const char* name, const Lap& one, const Lap& two) {
    const Case of{.group = "workers", .subject = name, .workers = 2};
    put(of, "one_us", median(one.wall_us));
    put(of, "two_us", median(two.wall_us));
    put(of, "one_over_two", median(one.wall_us) / median(two.wall_us));
  };
  report("fma_peak", laps[0], laps[1]);
  report("the paper's network on 6890 nodes", laps[2], laps[3]);
}

// The rows of P of `copies` characters, one behind the other.
TorusGraph repeated(const TorusGraph& one, uint32_t copies) {
  TorusGraph all(one);
  for (uint32_t copy = 1; copy < copies; ++copy) {
    for (uint32_t e = 0; e < one.neighbours.size(); ++e) {
      all.neighbours.push_back(one.neighbours[e] + copy * one.nodes());
      all.values.push_back(one.values[e]);
    }
    for (uint32_t node = 1; node <= one.nodes(); ++node)
      all.row_starts.push_back(copy * one.row_starts.back() + one.row_starts[node]);
  }
  return all;
}

// A form like the character's on 240 nodes.
NetworkShape shape_of(const pack::PackView& pack) {
  NetworkShape shape{pack.network->input_width, {}, pack.layers[0].has_self == 1, 20, 12};
  for (const pack::LayerRecord& layer : pack.layers) shape.channels.push_back(layer.channels);
  return shape;
}

void measure_batches(const demo::CharacterFile& character, int rounds) {
  const core::FloatingPointScope mode;
  RandomNetwork shipped(shape_of(character.view));
  const TorusGraph one(20, 12);
  for (const uint32_t copies : {1u, 2u, 4u, 8u, 16u}) {
    const TorusGraph all = repeated(one, copies);
    std::vector<Running> apart;
    for (uint32_t copy = 0; copy < copies; ++copy) apart.emplace_back(shipped.view(), one.view());
    Running together(shipped.view(), all.view());
    std::vector<Lap> laps = {
        {"apart", 4, [&] { std::ranges::for_each(apart, &Running::step); }},
        {"together", 4, [&] { together.step(); }},
    };
    run_laps(laps, rounds);
    const Case of{.group = "batches", .subject = "network step", .instances = copies, .workers = 1};
    put(of, "apart_us", median(laps[0].cpu_us) / copies);
    put(of, "together_us", median(laps[1].cpu_us) / copies);
  }
}

}  // namespace sinew::perf

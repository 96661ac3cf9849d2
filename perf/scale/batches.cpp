// batches.cpp  Several characters' control graphs as one network.
#include "core/floating_point.hpp"
#include "perf/kernels/bench_data.hpp"
#include "perf/scale/groups.hpp"
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
        scratch_(tissue::scratch_floats(network, graph.node_count)),
        z_(random_floats(simd::pad_to_block(network.record->input_width) * graph.node_count, 0.1f)) {}

  void step() { tissue::network_step(network_, graph_, z_.data(), nullptr, state_.data(), scratch_.data()); }

 private:
  tissue::Network network_;
  tissue::Graph graph_;
  Floats state_, scratch_, z_;
};

}  // namespace

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

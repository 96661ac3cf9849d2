// test_narrow_layer.cpp  Layers of few channels have the bits of the general kernels.
#include <utility>

#include "tests/simd/every_isa.hpp"
#include "tests/tissue/reference_network.hpp"

using namespace sinew;

namespace {

constexpr uint32_t kInputs = 41;

struct Case {
  Case(uint32_t nodes, const std::vector<size_t>& channels, bool has_self)
      : random(nodes), graph(test::ring_with_chords(nodes)), packed(record(), layers(channels, has_self)) {
    const size_t floats = tissue::state_floats(packed.view(), nodes);
    for (uint32_t l = 0; l < channels.size(); ++l) {
      const size_t padded = packed.view().layers[l].padded;
      test::Floats plane = test::random_rows(random, 3 * nodes, channels[l], padded, 1);
      start.insert(start.end(), plane.data(), plane.data() + 3 * nodes * padded);
    }
    REQUIRE(start.size() == floats);
    carry = test::random_floats(random, size_t{3} * nodes, 0.1f);
  }
  static pack::NetworkRecord record() {
    pack::NetworkRecord record = test::plain_record();
    record.output_scale = 0.15f;
    record.hidden_leak = 0.2f;
    record.state_clamp = 0.5f;
    return record;
  }
  std::vector<test::PlainLayer> layers(const std::vector<size_t>& channels, bool has_self) {
    std::vector<test::PlainLayer> out;
    size_t inputs = kInputs;
    for (const size_t width : channels)
      out.push_back(test::random_layer(random, std::exchange(inputs, width), width, has_self));
    return out;
  }
  // The state after three steps of step(graph, z, carry, state).
  template <class Step>
  std::vector<float> stepped(const Step& step) {
    const auto nodes = static_cast<uint32_t>(graph.rows.size() - 1);
    std::mt19937 inputs(7);
    test::Floats state(start.size());
    std::copy(start.begin(), start.end(), state.data());
    for (int tick = 0; tick < 3; ++tick) {
      test::Floats z = test::random_rows(inputs, nodes, kInputs, simd::pad_to_block(kInputs), 1);
      step({nodes, graph.rows.data(), graph.columns.data(), graph.values.data()}, z.data(), carry.data(),
           state.data());
    }
    return state.copy();
  }

  std::mt19937 random;
  test::TestGraph graph;
  test::PackedNetwork packed;
  std::vector<float> start, carry;
};

// The step with kernels of any width, one range of all nodes.
struct GeneralStep {
  tissue::Network network;

  void operator()(const tissue::Graph& graph, const float* z, const float* carry, float* state) const {
    const simd::SparseRows rows{graph.rows, graph.columns, graph.values};
    const size_t most = graph.node_count * size_t{48};
    test::Floats heard(most), gate(most), y_next(most), tile(simd::tile_floats(48));
    simd::kernels().aggregate(rows, z, 48, 0, graph.node_count, heard.data());
    const float* x = z;
    for (uint32_t l = 0; l < network.layers.size(); ++l) {
      const pack::LayerRecord& layer = network.layers[l];
      const tissue::LayerState own = tissue::layer_state(network, graph.node_count, l, state);
      const bool is_last = l + 1 == network.layers.size();
      simd::LayerJob job{
          .graph = rows, .inputs = layer.inputs, .channels = layer.channels, .padded = layer.padded};
      job.w_x = network.weights + layer.w_x;
      job.w_s = layer.has_self ? network.weights + layer.w_s : nullptr;
      job.w_h = network.weights + layer.w_h;
      job.w_y = network.weights + layer.w_y;
      job.bias = network.weights + layer.bias;
      job.x = x;
      job.x_stride = simd::pad_to_block(layer.inputs);
      job.px = job.pc = heard.data();
      job.h = own.h, job.c = own.c, job.y = own.y;
      job.carry = is_last ? carry : nullptr;
      job.y_keep = is_last ? 1 - network.record->output_leak : 1 - network.record->hidden_leak;
      job.y_gain = is_last ? network.record->output_scale : 1;
      job.clamp = network.record->state_clamp;
      job.y_next = is_last ? y_next.data() : nullptr;
      job.output_gate = gate.data();
      job.tile = tile.data();
      simd::kernels().layer_cells(job, 0, graph.node_count);
      simd::kernels().layer_output(job, 0, graph.node_count);
      x = own.c;
    }
  }
};

std::vector<float> stepped_alone(Case& of, uint32_t nodes) {
  test::Floats scratch(tissue::scratch_floats(of.packed.view(), nodes), 1e30f);
  return of.stepped([&](const tissue::Graph& graph, const float* z, const float* carry, float* state) {
    tissue::network_step(of.packed.view(), graph, z, carry, state, scratch.data());
  });
}

}  // namespace

// 4 and 8 floats a gate, full and not; with a wide layer before and behind; nodes that fill no tile or range.
TEST_CASE("narrow_layers_have_the_bits_of_the_general_kernels") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const std::vector<size_t>& channels :
         {std::vector<size_t>{8, 8, 3}, {5, 4, 3}, {1, 3}, {20, 7, 3}, {8, 33, 3}}) {
      for (const uint32_t nodes : {2u, 3u, 7u, 47u, 48u, 49u, 101u}) {
        for (const bool has_self : {true, false}) {
          Case of(nodes, channels, has_self);
          INFO(channels.size() << " layers, the first of " << channels[0] << "; " << nodes << " nodes");
          REQUIRE(stepped_alone(of, nodes) == of.stepped(GeneralStep{of.packed.view()}));
        }
      }
    }
  });
}

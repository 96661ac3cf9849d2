// test_layer.cpp  A layer's two passes over ranges of nodes; its numbers are tested through
// tests/tissue/test_network.cpp.
#include "tests/simd/every_isa.hpp"
#include "tests/tissue/reference_network.hpp"

using namespace sinew;

namespace {

constexpr uint32_t kNodes = simd::kRangeNodes + 9, kPadded = 48;
constexpr size_t kPlane = kNodes * kPadded;

// Both passes of one layer, hidden or last, each cut at the given node as two workers would.
std::vector<float> stepped_in_two(const simd::Kernels& kernels, bool is_last, uint32_t cut) {
  std::mt19937 random(3);
  const test::TestGraph graph = test::ring_with_chords(kNodes);
  test::PackedNetwork packed(test::plain_record(), {test::random_layer(random, 33, 40, true)});
  const tissue::Network network = packed.view();
  const pack::LayerRecord& layer = network.layers[0];
  test::Floats x = test::random_rows(random, kNodes, 33, kPadded, 1), px(kPlane), pc(kPlane);
  test::Floats state = test::random_rows(random, 3 * kNodes, 40, kPadded, 1), passed(2 * kPlane);
  test::Floats tile(simd::tile_floats(kPadded));
  simd::LayerJob job{.graph = graph.view(), .inputs = 33, .channels = 40, .padded = kPadded};
  job.w_x = network.weights + layer.w_x;
  job.w_s = network.weights + layer.w_s;
  job.w_h = network.weights + layer.w_h;
  job.w_y = network.weights + layer.w_y;
  job.bias = network.weights + layer.bias;
  job.x = x.data();
  job.x_stride = kPadded;
  job.px = px.data();
  job.pc = pc.data();
  job.h = state.data();
  job.c = state.data() + kPlane;
  job.y = state.data() + 2 * kPlane;
  job.clamp = 8;
  job.y_next = is_last ? passed.data() : nullptr;
  job.output_gate = passed.data() + kPlane;
  job.tile = tile.data();
  const uint32_t ranges[2][2] = {{cut, kNodes}, {0, cut}};
  for (const auto& range : ranges) {
    kernels.aggregate(graph.view(), x.data(), kPadded, range[0], range[1], px.data());
    kernels.layer_cells(job, range[0], range[1]);
  }
  for (const auto& range : ranges) {
    kernels.layer_output(job, range[0], range[1]);
    std::copy_n(pc.data(), (range[1] - range[0]) * kPadded, x.data() + range[0] * kPadded);
  }
  std::vector<float> result = state.copy(), heard = x.copy();
  result.insert(result.end(), heard.begin(), heard.end());
  return result;
}

}  // namespace

TEST_CASE("layer_gives_the_same_bits_wherever_its_nodes_are_cut") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const bool is_last : {false, true}) {
      const std::vector<float> whole = stepped_in_two(kernels, is_last, 0);
      for (uint32_t cut = 1; cut <= kNodes; ++cut) REQUIRE(stepped_in_two(kernels, is_last, cut) == whole);
    }
  });
}

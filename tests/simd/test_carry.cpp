// test_carry.cpp  Nodes to vertices, against plain sums in double.
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr double kRounding =
    64 * 6e-8;  // 64 nodes, weights and displacements below 1: at most one rounding a term

struct CarryCase {
  uint32_t nodes;
  size_t stride;
  test::Floats weights, displacement;
};

CarryCase carry_case(uint32_t nodes, size_t stride) {
  std::mt19937 random(nodes * 1000 + static_cast<uint32_t>(stride));
  return {nodes, stride, test::random_rows(random, nodes, stride, stride, 1),
          test::random_rows(random, nodes, 3, 3, 1)};
}

std::vector<float> carried(const simd::Kernels& kernels, CarryCase& c) {
  test::Floats out(3 * c.stride, 99);
  kernels.carry(c.weights.data(), c.nodes, c.stride, c.displacement.data(), out.data());
  return out.copy();
}

}  // namespace

TEST_CASE("carry_is_the_weighted_sum_of_the_nodes_displacements") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t nodes : {0u, 1u, 2u, 40u, 64u}) {
      for (const size_t stride : {16u, 32u, 48u, 64u, 80u, 176u}) {
        CarryCase c = carry_case(nodes, stride);
        const std::vector<float> out = carried(kernels, c);
        for (size_t i = 0; i < out.size(); ++i) {
          double exact = 0;
          for (size_t n = 0; n < nodes; ++n) {
            exact +=
                static_cast<double>(c.weights[n * stride + i % stride]) * c.displacement[n * 3 + i / stride];
          }
          REQUIRE(std::fabs(out[i] - exact) <= kRounding);
        }
      }
    }
  });
}

TEST_CASE("carry_has_the_same_bits_on_all_targets_with_fma") {
  CarryCase c = carry_case(40, 176);
  test::require_same_bits_where_fused(0xf27554dc8d962fba,
                                      [&](const simd::Kernels& kernels) { return carried(kernels, c); });
}

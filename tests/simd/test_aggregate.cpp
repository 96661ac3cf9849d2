// test_aggregate.cpp  Sparse rows times dense rows, against plain sums in double.
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr double kRounding = 16 * 6e-8;  // fewer than 16 terms below 1 a sum
constexpr float kUntouched = 55;

}  // namespace

TEST_CASE("aggregate_is_the_sparse_product_and_touches_only_its_nodes") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t nodes : {2u, 5u, 42u}) {
      const test::TestGraph graph = test::ring_with_chords(nodes);
      for (const size_t stride : {16u, 32u, 48u, 64u, 112u, 128u}) {
        std::mt19937 random(nodes);
        test::Floats x = test::random_rows(random, nodes, stride, stride, 1), out(nodes * stride, kUntouched);
        kernels.aggregate(graph.view(), x.data(), stride, 1, nodes, out.data() + stride);
        for (size_t i = 0; i < nodes; ++i) {
          for (size_t j = 0; j < stride; ++j) {
            double exact = i == 0 ? kUntouched : 0.0;
            for (uint32_t e = graph.rows[i]; i > 0 && e < graph.rows[i + 1]; ++e) {
              exact += static_cast<double>(graph.values[e]) * x[graph.columns[e] * stride + j];
            }
            REQUIRE(std::fabs(out[i * stride + j] - exact) <= kRounding);
          }
        }
      }
    }
  });
}

TEST_CASE("aggregate_has_the_same_bits_on_all_targets_with_fma") {
  const test::TestGraph graph = test::ring_with_chords(42);
  std::mt19937 random(1);
  test::Floats x = test::random_rows(random, 42, 112, 112, 1);
  test::require_same_bits_where_fused(0x0a182996ca6493c0, [&](const simd::Kernels& kernels) {
    test::Floats out(42 * 112);
    kernels.aggregate(graph.view(), x.data(), 112, 0, 42, out.data());
    return out.copy();
  });
}

// test_rows.cpp  Weighted sums of rows, against plain sums in double.
#include "core/floating_point.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr double kEpsilon = 6e-8;  // half a unit in the last place of numbers below 1, a rounding a term

struct RowsCase {
  uint32_t count;
  size_t stride;
  test::Floats rows, weights;
};

RowsCase rows_case(uint32_t count, size_t stride) {
  std::mt19937 random(count * 1000 + static_cast<uint32_t>(stride));
  return {count, stride, test::random_rows(random, count, stride, stride, 1),
          test::random_rows(random, 1, count, count, 1)};
}

std::vector<float> added(const simd::Kernels& kernels, RowsCase& c) {
  test::Floats out(c.stride, 99);
  kernels.add_rows(c.rows.data(), c.count, c.stride, c.weights.data(), out.data());
  return out.copy();
}

template <class Check>
void for_every_size(const Check& check) {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t count : {0u, 1u, 7u, 64u}) {
      for (const size_t stride : {16u, 32u, 48u, 128u, 12288u}) {
        RowsCase c = rows_case(count, stride);
        check(kernels, c);
      }
    }
  });
}

}  // namespace

TEST_CASE("add_rows_is_the_rows_weighted_sum") {
  for_every_size([](const simd::Kernels& kernels, RowsCase& c) {
    const std::vector<float> out = added(kernels, c);
    for (size_t i = 0; i < c.stride; ++i) {
      double exact = 0;
      for (size_t k = 0; k < c.count; ++k)
        exact += static_cast<double>(c.weights[k]) * static_cast<double>(c.rows[k * c.stride + i]);
      REQUIRE(std::fabs(static_cast<double>(out[i]) - exact) <= 8 * kEpsilon * (c.count + 1));
    }
  });
}

// Products on both sides of the smallest normal number, 1.2e-38, as gates decay to.
TEST_CASE("denormals_are_flushed_to_the_same_bits_on_all_targets_with_fma") {
  RowsCase c = rows_case(64, 176);
  for (size_t i = 0; i < c.rows.size(); ++i) c.rows[i] *= 1e-19f;
  for (size_t k = 0; k < c.count; ++k) c.weights[k] *= 1e-19f;
  const core::FloatingPointScope mode;
  test::require_same_bits_where_fused(0xbdf9280ef707656d,
                                      [&](const simd::Kernels& kernels) { return added(kernels, c); });
}

TEST_CASE("rows_have_the_same_bits_on_all_targets_with_fma") {
  RowsCase c = rows_case(64, 176);
  test::require_same_bits_where_fused(0x11132a3c8c2a4624,
                                      [&](const simd::Kernels& kernels) { return added(kernels, c); });
}

// test_hold.cpp  Rows brought to scale and held, number by number.
#include <cmath>
#include <limits>

#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

TEST_CASE("hold_rows_scales_clamps_and_counts_as_a_plain_loop") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr size_t kStride = 48;
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t count : {1u, 2u, 7u, 40u}) {
      std::mt19937 random(count);
      test::Floats rows = test::random_rows(random, count, 41, kStride, 4), scale(kStride), bound(kStride);
      for (size_t j = 0; j < 41; ++j) scale[j] = 1.5f, bound[j] = j % 5 == 0 ? kInfinity : 2.0f;
      rows[3] = NAN, rows[5] = kInfinity, rows[6] = -kInfinity, rows[10] = 3e38f;  // the last overflows
      std::vector<float> want = rows.copy();
      uint32_t held = 0;
      for (size_t i = 0; i < want.size(); ++i) {
        const float x = want[i] * scale[i % kStride], most = bound[i % kStride];
        want[i] = std::isfinite(x) ? std::min(std::max(x, -most), most) : 0;
        held += !std::isfinite(x) || want[i] != x;
      }
      CHECK(kernels.hold_rows(rows.data(), count, kStride, scale.data(), bound.data()) == held);
      CHECK(rows.copy() == want);
    }
  });
}

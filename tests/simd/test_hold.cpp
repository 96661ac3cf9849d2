// test_hold.cpp  Columns brought to scale, held and laid out as rows, number by number.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

TEST_CASE("hold_columns_scales_clamps_counts_and_transposes_as_a_plain_loop") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr size_t kWidth = 48, kUsed = 41;
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t count : {0u, 1u, 2u, 7u, 8u, 15u, 16u}) {
      std::mt19937 random(count);
      test::Floats columns = test::random_rows(random, kUsed, simd::kBlock, simd::kBlock, 4);
      test::Floats all(kWidth * simd::kBlock), scale(kWidth), bound(kWidth), rows(count * kWidth + 16, 99);
      std::copy_n(columns.data(), columns.size(), all.data());
      for (size_t j = 0; j < kUsed; ++j) scale[j] = 1.5f, bound[j] = j % 5 == 0 ? kInfinity : 2.0f;
      for (size_t i = 0; i < simd::kBlock; ++i)
        all[17 * simd::kBlock + i] = NAN;                                      // in rows that are none too
      all[3] = NAN, all[5] = kInfinity, all[6] = -kInfinity, all[10] = 3e38f;  // the last overflows
      std::vector<float> want(count * kWidth + 16, 99);
      uint32_t held = 0;
      for (size_t i = 0; i < count; ++i) {
        for (size_t j = 0; j < kWidth; ++j) {
          const float x = all[j * simd::kBlock + i] * scale[j], most = bound[j];
          want[i * kWidth + j] = std::isfinite(x) ? std::min(std::max(x, -most), most) : 0;
          held += !std::isfinite(x) || want[i * kWidth + j] != x;
        }
      }
      CHECK(kernels.hold_columns({all.data(), scale.data(), bound.data(), rows.data(), kWidth, count}) ==
            held);
      CHECK(rows.copy() == want);
    }
  });
}

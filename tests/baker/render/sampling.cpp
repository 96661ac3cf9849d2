// sampling.cpp  Sample patterns: stratified in a pixel, fine-grained across pixels.
#include <catch2/catch.hpp>
#include <set>

#include "baker/render/sampling.hpp"

using namespace sinew::render;

TEST_CASE("any_sixteen_samples_of_a_stream_fall_into_sixteen_cells") {
  for (const uint32_t start : {0u, 16u, 48u}) {
    std::set<int> cells;
    for (uint32_t i = 0; i < 16; ++i) {
      const Eigen::Vector2f p = stratified_point(start + i);
      cells.insert(static_cast<int>(4 * p.x()) + 4 * static_cast<int>(4 * p.y()));
    }
    CHECK(cells.size() == 16);
  }
}

TEST_CASE("streams_of_a_pixel_stay_in_the_unit_square_and_differ") {
  const PixelSamples first(7, 9, 0), second(7, 9, 1);
  for (uint32_t i = 0; i < 64; ++i) {
    for (const Eigen::Vector2f& p : {first(i), second(i)}) {
      CHECK((p.minCoeff() >= 0 && p.maxCoeff() < 1));
    }
    CHECK(first(i) != second(i));
  }
}

TEST_CASE("blue_noise_holds_every_level_once") {
  std::set<float> levels;
  for (uint32_t y = 0; y < kNoiseTile; ++y) {
    for (uint32_t x = 0; x < kNoiseTile; ++x) levels.insert(blue_noise(x, y));
  }
  CHECK(levels.size() == size_t{kNoiseTile} * kNoiseTile);
  CHECK(blue_noise(3, 5) == blue_noise(3 + kNoiseTile, 5 + 2 * kNoiseTile));
}

TEST_CASE("blue_noise_has_little_power_at_low_frequencies") {
  // White noise: means of 8 x 8 blocks vary by 1 / sqrt(12 x 64) = 0.036.
  double sum2 = 0;
  for (uint32_t by = 0; by < 8; ++by) {
    for (uint32_t bx = 0; bx < 8; ++bx) {
      double mean = 0;
      for (uint32_t i = 0; i < 64; ++i)
        mean += static_cast<double>(blue_noise(8 * bx + i % 8, 8 * by + i / 8)) / 64;
      sum2 += (mean - 0.5) * (mean - 0.5);
    }
  }
  constexpr double kHalfOfWhiteNoise = 0.018;
  CHECK(std::sqrt(sum2 / 64) < kHalfOfWhiteNoise);
}

TEST_CASE("cosine_directions_lie_around_the_normal_with_mean_two_thirds") {
  const Eigen::Vector3f n = Eigen::Vector3f(0.3f, -0.5f, 0.8f).normalized();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  constexpr uint32_t kCount = 4096;
  for (uint32_t i = 0; i < kCount; ++i) {
    const Eigen::Vector3f d = cosine_direction(n, stratified_point(i));
    REQUIRE(d.norm() == Approx(1).epsilon(1e-5));
    REQUIRE(d.dot(n) >= 0);
    sum += d;
  }
  CHECK((sum / kCount - 2.0f / 3 * n).norm() < 0.005f);
}

// test_bend.cpp  Three quarters of a turn, against axis and angle in double.
#include <Eigen/Geometry>

#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr size_t kStride = 15;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

struct Turns {
  explicit Turns(uint32_t count) : memory(kStride * count), angles(count) {
    std::mt19937 random(count);
    const auto direction = [&] {
      return Eigen::Vector3d(test::uniform(random, -1, 1), test::uniform(random, -1, 1), 1.5).normalized();
    };
    held = Eigen::AngleAxisd(2, direction()).toRotationMatrix();
    for (uint32_t i = 0; i < count; ++i) {
      angles[i] = 2.2 * i / count;  // below where the bend fades out
      axes.push_back(direction());
      Eigen::Map<Rows33>{&memory[kStride * i + 3]} =
          (held * Eigen::AngleAxisd(angles[i], axes[i]).toRotationMatrix()).cast<float>();
    }
  }
  simd::BendJob job() {
    simd::BendJob out{{}, &memory[3], &memory[12], kStride, static_cast<uint32_t>(angles.size())};
    Eigen::Map<Rows33>{out.held} = held.cast<float>();
    return out;
  }
  std::vector<float> memory;
  std::vector<double> angles;
  std::vector<Eigen::Vector3d> axes;
  Eigen::Matrix3d held;
};

}  // namespace

// Rounding of nine products and three roots: measured 8e-7.
TEST_CASE("share_bend_leaves_three_quarters_of_the_turn_and_tells_the_rest") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t count : {1u, 3u, 15u, 16u, 17u, 40u}) {
      Turns turns(count);
      kernels.share_bend(turns.job());
      for (uint32_t i = 0; i < count; ++i) {
        const Eigen::Matrix3d want =
            turns.held * Eigen::AngleAxisd(0.75 * turns.angles[i], turns.axes[i]).toRotationMatrix();
        const Eigen::Map<const Rows33> have(&turns.memory[kStride * i + 3]);
        const Eigen::Map<const Eigen::Vector3f> bend(&turns.memory[kStride * i + 12]);
        REQUIRE((have.cast<double>() - want).cwiseAbs().maxCoeff() <= 2e-6);
        REQUIRE((bend.cast<double>() - 0.25 * turns.angles[i] * turns.axes[i]).norm() <= 2e-6);
        for (size_t k = 0; k < 3; ++k) REQUIRE(turns.memory[kStride * i + k] == 0);  // places are left alone
      }
    }
  });
}

// Frames that are none, so that all of the fading is met.
TEST_CASE("share_bend_has_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0xa4bbdcfecf7b4a9b, [](const simd::Kernels& kernels) {
    std::mt19937 random(5);
    test::Floats frames = test::random_rows(random, 23, kStride, kStride, 0.8f);
    simd::BendJob job{{}, frames.data() + 3, frames.data() + 12, kStride, 23};
    for (float& number : job.held) number = test::uniform(random, -0.8f, 0.8f);
    kernels.share_bend(job);
    return frames.copy();
  });
}

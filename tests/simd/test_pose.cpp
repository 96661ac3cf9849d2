// test_pose.cpp  Frames of blended matrices, against Gram-Schmidt in double.
#include <Eigen/Geometry>

#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr size_t kStride = 15;  // floats: place, turn, and three that are left alone
constexpr float kUntouched = 7;
constexpr uint32_t kJoints = 5;

struct Skin {
  uint16_t joint[simd::kInfluences] = {};
  float weight[simd::kInfluences] = {};
};

// Frames on two or three joints that turn, scale and shear.
struct Frames {
  explicit Frames(uint32_t frames)
      : count(frames),
        points(3 * count),
        matrices(12 * kJoints),
        skins(count + 1),  // one to point at where there is none

        out(kStride * count, kUntouched) {
    std::mt19937 random(count + 1);
    for (float& value : points) value = test::uniform(random, -1, 1);
    for (uint32_t k = 0; k < 12 * kJoints; ++k)
      matrices[k] = test::uniform(random, -0.3f, 0.3f) + (k % 12 % 5 == 0 ? 1.0f : 0.0f);
    for (uint32_t i = 0; i < count; ++i) {
      skins[i].weight[0] = 0.6f;
      skins[i].weight[1] = 0.4f;
      for (uint32_t k = 0; k < 2; ++k) skins[i].joint[k] = static_cast<uint16_t>((i + 2 * k) % kJoints);
    }
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>{root} =
        Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix().cast<float>();
  }
  simd::SkinJob job() {
    return {points.data(), 12,          skins[0].joint, skins[0].weight, sizeof(Skin), matrices.data(),
            out.data(),    4 * kStride, count};
  }
  Eigen::Matrix<double, 3, 4> blended(size_t i) const {
    Eigen::Matrix<double, 3, 4> sum = Eigen::Matrix<double, 3, 4>::Zero();
    for (size_t k = 0; k < 2; ++k)
      sum += static_cast<double>(skins[i].weight[k]) *
             Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(
                 &matrices[size_t{12} * skins[i].joint[k]])
                 .cast<double>();
    return sum;
  }
  uint32_t count;
  float root[9];
  std::vector<float> points, matrices;
  std::vector<Skin> skins;
  std::vector<float> out;
};

using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

Matrix3d orthonormal(const Matrix3d& m) {
  Matrix3d axes;
  axes.col(0) = m.col(0).normalized();
  axes.col(1) = (m.col(1) - axes.col(0) * axes.col(0).dot(m.col(1))).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

// Places are sums of a dozen numbers of the size of one; axes lose a digit where columns are 0.3 long across.
TEST_CASE("pose_frames_gives_blended_places_and_orthonormal_axes") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t count : {0u, 1u, 3u, 15u, 16u, 17u, 40u}) {
      Frames frames(count);
      kernels.pose_frames(frames.job(), frames.root);
      for (uint32_t i = 0; i < count; ++i) {
        const auto m = frames.blended(i);
        const Matrix3d root = Eigen::Map<const Rows33>(frames.root).cast<double>();
        const Vector3d point = Eigen::Map<const Eigen::Vector3f>(&frames.points[3 * i]).cast<double>();
        const float* have = &frames.out[kStride * i];
        const Vector3d place = Eigen::Map<const Eigen::Vector3f>(have).cast<double>();
        const Matrix3d turn = Eigen::Map<const Rows33>(have + 3).cast<double>();
        REQUIRE((place - root * (m.leftCols<3>() * point + m.col(3))).norm() < 2e-6);
        REQUIRE((turn - root * orthonormal(m.leftCols<3>())).norm() < 4e-6);
        for (size_t k = 12; k < kStride; ++k) REQUIRE(have[k] == kUntouched);
      }
    }
  });
}

TEST_CASE("a_frame_of_a_collapsed_matrix_is_still_a_rotation") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const int kept : {0, 1, 2, 3}) {  // columns, the others zero; 3: all alike
      Frames frames(17);
      for (size_t joint = 0; joint < kJoints; ++joint) {
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 3; ++column) {
            float& m =
                frames.matrices[12 * joint + 4 * static_cast<size_t>(row) + static_cast<size_t>(column)];
            m = kept == 3 ? static_cast<float>(row + 1) : column < kept ? m : 0.0f;
          }
        }
      }
      kernels.pose_frames(frames.job(), frames.root);
      for (uint32_t i = 0; i < frames.count; ++i) {
        const Matrix3d turn = Eigen::Map<const Rows33>(&frames.out[kStride * i + 3]).cast<double>();
        REQUIRE((turn.transpose() * turn - Matrix3d::Identity()).norm() < 4e-6);
        REQUIRE(turn.determinant() > 0);
      }
    }
  });
}

TEST_CASE("poses_have_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0xfe6a43f034491057, [](const simd::Kernels& kernels) {
    Frames frames(40);
    kernels.pose_frames(frames.job(), frames.root);
    return frames.out;
  });
}

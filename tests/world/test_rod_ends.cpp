// test_rod_ends.cpp  Rods whose ends are held by another bone than their beginnings.
#include <Eigen/Geometry>
#include <cmath>
#include <cstring>

#include "tests/world/stage.hpp"

using namespace sinew;
using Eigen::Vector3d;
using scenes::kBone_m;
using scenes::kHorns;
using scenes::kTail;
using scenes::TailedPose;
using test::Stage;

namespace {

// A seam gives by a hundredth of a gap; and bones are shown in the pose, up to a tick after the one that was
// simulated.
constexpr double kSeam_m = 2e-3;

const scenes::PackBytes& sewn_pack() {
  static const scenes::PackBytes pack =
      scenes::soft_block({.network = false, .rods = scenes::RodMatter{.sewn = true}});
  return pack;
}

struct SewnStage : Stage {
  explicit SewnStage(uint32_t count = 1) : Stage(count, {}, sewn_pack()) {}

  void hold(const TailedPose& pose, double seconds) {
    for (int f = 0; f < std::lround(seconds * 60); ++f) {
      REQUIRE(world.set_pose(blocks[0], pose.pose()).ok());
      world.step(1.0f / 60);
    }
  }
  std::vector<Matrix34> joints() const {
    std::vector<Matrix34> out(info.joint_count);
    REQUIRE(world.read_joint_matrices(blocks[0], out).ok());
    return out;
  }
  // Of the last bone of a chain, whose bones all have this step in the bind pose.
  Vector3d end_of(uint32_t last, const Vector3d& step) const {
    const std::vector<Matrix34> now = joints();
    const auto joint =
        Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&now[last].m[0][0]).cast<double>();
    return joint.leftCols<3>() * step + joint.col(3);
  }
  Vector3d tip() const { return end_of(kTail + 3, {0, 0, -kBone_m}); }
  Vector3d left_horn() const { return end_of(kHorns[0] + 2, {-0.06, 0.08, 0}); }
  Vector3d right_horn() const { return end_of(kHorns[1] + 2, {0.06, 0.08, 0}); }
};

// The waist, and with it the beginnings of all rods, turned about the vertical and moved backwards and, a
// third as far, to its right.
TailedPose turned(double turn_rad, double back_m) {
  scenes::BlockPose block = scenes::bind_pose();
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> waist(&block.joints[1].m[0][0]);
  waist.leftCols<3>() =
      Eigen::AngleAxisd(turn_rad, Vector3d::UnitY()).toRotationMatrix().cast<float>() * waist.leftCols<3>();
  waist(0, 3) -= static_cast<float>(back_m / 3);
  waist(2, 3) -= static_cast<float>(back_m);
  return scenes::with_rods(block);
}

TailedPose standing() { return scenes::with_rods(scenes::bind_pose()); }

}  // namespace

TEST_CASE("a_rod_s_end_stays_where_it_is_held_while_its_beginning_turns_and_other_rods_go_along") {
  SewnStage stage;
  stage.hold(standing(), 0.2);
  const Vector3d tip = stage.tip(), left = stage.left_horn(), right = stage.right_horn();
  double torn = 0;
  for (int f = 1; f <= 120; ++f) {  // two seconds there, each pose within reach
    stage.hold(turned(0.5 * f / 120, 0.06 * f / 120), 1.0 / 60);
    torn = std::max({torn, (stage.tip() - tip).norm(), (stage.left_horn() - left).norm()});
  }
  CHECK(torn < kSeam_m);
  CHECK((stage.right_horn() - right).norm() > 0.05);  // free
  stage.hold(turned(0.5, 0.06), 20);
  CHECK((stage.tip() - tip).norm() < kSeam_m);
  CHECK(stage.report().rods_asleep == 3);
  CHECK(stage.report().rod_recoveries == 0);
  stage.hold(standing(), 20);
  CHECK((stage.tip() - tip).norm() < kSeam_m);
}

TEST_CASE("a_rod_starts_in_a_pose_that_tears_its_seam_and_closes_it_without_being_thrown") {
  SewnStage stage;
  stage.hold(standing(), 1.0 / 60);
  const Vector3d tip = stage.tip();
  REQUIRE(stage.world.reset(stage.blocks[0]).ok());
  double before_m = 1e9;
  for (int f = 0; f < 60; ++f) {
    stage.hold(turned(0.5, 0.06), 1.0 / 60);
    const double torn_m = (stage.tip() - tip).norm();
    CHECK(torn_m < before_m + kSeam_m);  // closer and closer
    before_m = torn_m;
  }
  CHECK(before_m < kSeam_m);
}

TEST_CASE("a_rod_that_cannot_reach_where_its_end_is_held_points_there_and_comes_back") {
  SewnStage stage;
  stage.hold(standing(), 0.2);
  const Vector3d tip = stage.tip();
  const TailedPose far = turned(1.2, -0.2);
  stage.hold(far, 5);
  const std::vector<Matrix34> joints = stage.joints();
  const Vector3d begin(static_cast<double>(joints[kTail].m[0][3]), static_cast<double>(joints[kTail].m[1][3]),
                       static_cast<double>(joints[kTail].m[2][3]));
  const double gap_m = (tip - begin).norm() - 4 * kBone_m;
  REQUIRE(gap_m > 0.1);
  CHECK((stage.tip() - tip).norm() == Approx(gap_m).margin(5e-3));  // straight, but for its stiffness
  CHECK(stage.report().rod_recoveries == 0);
  stage.hold(standing(), 20);
  CHECK((stage.tip() - tip).norm() < kSeam_m);
}

TEST_CASE("rods_asleep_wake_with_the_bone_that_holds_their_end") {
  SewnStage stage;
  stage.hold(standing(), 20);
  REQUIRE(stage.report().rods_asleep == 3);
  TailedPose pose = standing();
  pose.joints[0].m[0][3] += 0.02f;  // across the tail, half a millimetre further than it reaches
  const Vector3d tip = stage.tip();
  stage.hold(pose, 1);
  CHECK(stage.report().rods_asleep == 0);
  CHECK((stage.tip() - tip - Vector3d(0.02, 0, 0)).norm() < kSeam_m);
}

TEST_CASE("rods_with_held_ends_have_the_same_bits_after_a_restore") {
  SewnStage stage;
  const auto play = [&] {
    std::vector<std::vector<Matrix34>> seen;
    for (int f = 0; f < 60; ++f) {
      stage.hold(turned(0.4 * std::sin(0.1 * f), 0.06), 1.0 / 60);
      seen.push_back(stage.joints());
    }
    return seen;
  };
  play();
  const std::vector<std::byte> saved = stage.save();
  const auto first = play();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  const auto second = play();
  for (size_t f = 0; f < first.size(); ++f)
    REQUIRE(std::memcmp(first[f].data(), second[f].data(), first[f].size() * sizeof(Matrix34)) == 0);
}

TEST_CASE("violent_poses_leave_rods_with_held_ends_finite_and_they_come_back") {
  SewnStage stage;
  stage.hold(standing(), 0.2);
  const Vector3d tip = stage.tip();
  uint32_t seed = 7;
  const auto next = [&] {
    return static_cast<double>((seed = seed * 1664525u + 1013904223u) >> 8) / 8388608.0 - 1;
  };
  for (int f = 0; f < 600; ++f) {
    TailedPose pose = turned(3 * next(), next());
    for (int k = 0; k < 3; ++k) pose.root.position_m[k] = next();
    stage.hold(pose, 1.0 / 60);
    for (const Matrix34& joint : stage.joints())
      for (const auto& row : joint.m)
        for (const float value : row) REQUIRE(std::isfinite(value));
  }
  stage.hold(standing(), 30);
  CHECK((stage.tip() - tip).norm() < kSeam_m);
}

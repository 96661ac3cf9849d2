// test_node_bend.cpp  Frames between the anchor's and the flesh's own.
#include "tissue/frames/node_bend.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tissue/node_poses.hpp"

using namespace sinew;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kRounding = 1e-6;  // of rotations, in float

const Vector3d kAxis = Vector3d(1, -2, 0.4).normalized();

Matrix3d about(double angle_rad) { return AngleAxisd(angle_rad, kAxis).toRotationMatrix(); }

Matrix3d rotation_of(const tissue::NodePose& pose) {
  return Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(pose.rotation).cast<double>();
}
Vector3d bend_of(const tissue::NodePose& pose) {
  return Eigen::Map<const Eigen::Vector3f>(pose.bend).cast<double>();
}

// A node whose flesh is bent by so much against its anchor's, which is turned in the world.
tissue::NodePose shared(double bend_rad, const Matrix3d& anchor = test::turned(0.7)) {
  tissue::NodePose nodes[2] = {test::node_pose(anchor * about(bend_rad)), test::node_pose(anchor)};
  tissue::share_bend(1, 2, nodes);
  CHECK((rotation_of(nodes[1]) - anchor).norm() < kRounding);
  CHECK(bend_of(nodes[1]).norm() < kRounding);
  return nodes[0];
}

}  // namespace

TEST_CASE("a_frame_that_is_not_a_number_is_not_bent") {
  const tissue::NodePose good = test::node_pose(test::turned(0.7));
  tissue::NodePose bad = good;
  bad.rotation[4] = std::nanf("");
  for (const bool anchor_is_bad : {false, true}) {
    tissue::NodePose nodes[2] = {anchor_is_bad ? bad : good, anchor_is_bad ? good : bad};
    tissue::share_bend(0, 2, nodes);
    for (const tissue::NodePose& node : nodes) CHECK(bend_of(node) == Vector3d::Zero());
    CHECK(rotation_of(nodes[anchor_is_bad]).allFinite());
  }
}

TEST_CASE("without_a_bend_frames_stay_as_they_are_to_the_bit") {
  const tissue::NodePose straight = test::node_pose(test::turned(0.7));
  tissue::NodePose nodes[3] = {straight, straight, straight};
  tissue::share_bend(2, 3, nodes);
  for (const tissue::NodePose& node : nodes) {
    CHECK(bend_of(node) == Vector3d::Zero());
    CHECK(rotation_of(node) == rotation_of(straight));
  }
}

TEST_CASE("a_frame_follows_three_quarters_of_the_bend") {
  for (const double bend : {-2.3, -1.0, -0.01, 0.3, 1.7, 2.3}) {
    const tissue::NodePose node = shared(bend);
    INFO("bend " << bend);
    CHECK((rotation_of(node) - test::turned(0.7) * about(0.75 * bend)).norm() < 4 * kRounding);
    CHECK((bend_of(node) - 0.25 * bend * kAxis).norm() < 2 * kRounding);
  }
}

TEST_CASE("a_vector_along_the_frame_is_told_along_the_flesh") {
  const Vector3d v(0.3, -0.1, 0.7);
  for (const double bend : {0.0, 0.5, -2.2}) {
    const tissue::NodePose node = shared(bend);
    Eigen::Vector3f along = v.cast<float>();
    tissue::along_flesh(&node, along.data(), 1, along.data());
    const Vector3d in_world = test::turned(0.7) * about(bend) * along.cast<double>();
    CHECK((in_world - rotation_of(node) * v).norm() < 4 * kRounding);
  }
}

// At a half turn the shorter way changes sides; a frame that followed it would jump.
TEST_CASE("frames_pass_a_half_turn_without_a_jump") {
  constexpr double kStep = 0.01;
  for (double bend = 2.4; bend < 3.9; bend += kStep) {
    const Matrix3d before = rotation_of(shared(bend)), after = rotation_of(shared(bend + kStep));
    CHECK((after - before).norm() < 5 * kStep);
  }
  CHECK((rotation_of(shared(M_PI)) - test::turned(0.7) * about(M_PI)).norm() < 4 * kRounding);
}

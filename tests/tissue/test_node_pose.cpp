// test_node_pose.cpp  Blended skin matrices become places and rotations.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/tissue/node_poses.hpp"

using namespace sinew;
using Eigen::Matrix3f;
using Eigen::Vector3f;

namespace {

constexpr float kRounding = 1e-6f;  // of places and rotations of the size of one
constexpr float kUpright[4] = {0, 0, 0, 1};

using Affine = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

Affine affine(const Matrix3f& linear, const Vector3f& offset = Vector3f::Zero()) {
  Affine m;
  m << linear, offset;
  return m;
}

Matrix3f about_z(float angle_rad) {
  return Eigen::AngleAxisf(angle_rad, Vector3f::UnitZ()).toRotationMatrix();
}

// A node at (1, 2, 3), on two joints by these shares.
tissue::NodePose posed(const Affine& a, const Affine& b, float share_a, const float root[4] = kUpright) {
  pack::NodeRecord node{};
  node.position_m[0] = 1;
  node.position_m[1] = 2;
  node.position_m[2] = 3;
  node.skin.weight[0] = share_a;
  node.skin.weight[1] = 1 - share_a;
  node.skin.joint[1] = 1;
  std::vector<float> skin(24);
  Eigen::Map<Affine>{skin.data()} = a;
  Eigen::Map<Affine>{skin.data() + 12} = b;
  tissue::NodePose pose;
  tissue::pose_nodes({&node, 1}, skin.data(), root, &pose);
  return pose;
}

Matrix3f rotation_of(const tissue::NodePose& pose) {
  return Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(pose.rotation);
}
Vector3f place_of(const tissue::NodePose& pose) { return Vector3f(pose.place_m); }

}  // namespace

TEST_CASE("a_collapsed_skin_matrix_still_gives_a_rotation") {
  Matrix3f line = Matrix3f::Zero(), plane = Matrix3f::Identity();
  line(0, 0) = 1;
  plane.col(1) = plane.col(0);
  for (const Matrix3f& m : {Matrix3f(Matrix3f::Zero()), line, plane}) {
    const Matrix3f r = rotation_of(posed(affine(m), affine(m), 1));
    CHECK((r.transpose() * r - Matrix3f::Identity()).norm() < kRounding * 4);
    CHECK(r.determinant() == Approx(1));
  }
}

TEST_CASE("the_bind_pose_leaves_nodes_where_they_are") {
  const tissue::NodePose pose = posed(affine(Matrix3f::Identity()), affine(Matrix3f::Identity()), 0.5f);
  CHECK(place_of(pose) == Vector3f(1, 2, 3));
  CHECK(rotation_of(pose) == Matrix3f::Identity());
}

TEST_CASE("a_blend_over_a_hinge_turns_by_half") {
  const tissue::NodePose pose = posed(affine(about_z(0)), affine(about_z(1.2f)), 0.5f);
  CHECK((rotation_of(pose) - about_z(0.6f)).norm() < kRounding * 4);
}

TEST_CASE("scale_is_taken_out_of_a_frame_but_not_out_of_a_place") {
  const tissue::NodePose pose = posed(affine(3 * about_z(0.7f)), affine(about_z(0)), 1);
  CHECK((rotation_of(pose) - about_z(0.7f)).norm() < kRounding * 4);
  CHECK((place_of(pose) - 3 * about_z(0.7f) * Vector3f(1, 2, 3)).norm() < kRounding * 12);
}

TEST_CASE("a_turned_root_turns_places_and_frames_alike") {
  const Eigen::Quaternionf root(Eigen::AngleAxisf(1.1f, Vector3f(1, -1, 0.5f).normalized()));
  const Affine bone = affine(about_z(0.4f), {0.1f, 0.2f, 0.3f});
  const tissue::NodePose still = posed(bone, bone, 1), turned = posed(bone, bone, 1, root.coeffs().data());
  CHECK((place_of(turned) - root * place_of(still)).norm() < kRounding * 8);
  CHECK((rotation_of(turned) - root.toRotationMatrix() * rotation_of(still)).norm() < kRounding * 4);
}

// trajectory.cpp  What a trajectory file holds is what happened, along the region frame's axes.
#include "baker/truth/trajectory.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sinew::baker;

namespace {

constexpr double kTick_s = 1.0 / 60;
constexpr double kFloat = 1e-6;         // rounding of metres to float
constexpr double kAcceleration = 5e-3;  // the same, twice divided by a tick: 1e-7 m x 3600 / s^2, with margin

// One joint, three vertices, one region of two nodes on the last two.
struct Scene {
  Character character;
  TissueLayout layout;
  Scene() {
    character.joint_node = {0};
    character.joint_parent = {-1};
    character.inverse_bind = {Matrix4::Identity()};
    character.positions = {Vector3(0, 0, 0), Vector3(0, 1, 0), Vector3(0.2, 1, 0)};
    Region region;
    region.node_count = 2;
    region.vertices = {1, 2};
    region.carry = {{1, 0}, {0, 1}};
    region.center = Vector3(0.1, 1, 0);
    region.radius_m = 0.1;
    layout.regions = {region};
    for (int vertex : {1, 2}) {
      ControlNode node;
      node.vertex = vertex;
      node.position = character.positions[static_cast<size_t>(vertex)];
      node.normal = Vector3::UnitX();
      node.stiffness = 0.25;
      layout.nodes.push_back(node);
    }
    layout.edges = {{0, 1}};
  }

  // The character's root at `root`, every vertex `offset` (world) from where skinning puts it.
  TruthFrame frame(const Matrix4& root, const Vector3& offset) const {
    TruthFrame out;
    out.pose.joints = {Matrix4::Identity()};
    out.pose.root = root;
    for (const Vector3& p : character.positions) {
      out.skinned.push_back((root * p.homogeneous()).head<3>());
      out.truth.push_back(out.skinned.back() + offset);
    }
    out.elastic_energy_j = 3;
    return out;
  }
};

Matrix4 rigid(const Vector3& place, double turn_about_y) {
  Matrix4 out = Matrix4::Identity();
  out.topLeftCorner<3, 3>() = Eigen::AngleAxisd(turn_about_y, Vector3::UnitY()).toRotationMatrix();
  out.topRightCorner<3, 1>() = place;
  return out;
}

Vector3 at(const Tensor& tensor, size_t first) {
  const std::vector<float> v = tensor.as_f32();
  return {v[first], v[first + 1], v[first + 2]};
}

}  // namespace

TEST_CASE("displacement_lies_along_the_region_frame") {
  const Scene scene;
  TrajectoryRecorder recorder(scene.character, scene.layout, {});
  recorder.add(scene.frame(rigid(Vector3(1000, 0, 0), std::acos(0.0)), Vector3(0.01, 0.02, 0)));
  const Safetensors file = recorder.finish({{"motion", "none"}});
  // A quarter turn about Y takes the region's Z to the world's X.
  CHECK((at(file.need("displacement", {1, 2, 3}), 3) - Vector3(0, 0.02, 0.01)).norm() < kFloat);
  CHECK(file.metadata.at("sinew.trajectory") == "1");
  CHECK(file.metadata.at("motion") == "none");
}

TEST_CASE("drive_is_zero_at_the_start_and_minus_the_acceleration_after") {
  const Scene scene;
  const Vector3 acceleration(3, 0, -1);
  TrajectoryRecorder recorder(scene.character, scene.layout, {});
  for (int tick = 0; tick < 5; ++tick) {
    const double t = tick * kTick_s;
    recorder.add(scene.frame(rigid(acceleration * t * t / 2, 0), Vector3::Zero()));
  }
  const Safetensors file = recorder.finish({});
  const Tensor& drive = file.need("drive", {5, 2, sinew::tissue::kDriveWidth});
  const size_t row = 2 * sinew::tissue::kDriveWidth;
  CHECK(at(drive, 0).norm() == 0);
  CHECK((at(drive, 4 * row) + acceleration).norm() < kAcceleration);
  CHECK((at(drive, 4 * row + sinew::tissue::kDriveWidth) + acceleration).norm() < kAcceleration);
}

TEST_CASE("the_second_region_keeps_its_own_history") {
  Scene scene;
  Region second = scene.layout.regions[0];
  second.first_node = 2;
  scene.layout.regions.push_back(second);
  for (int k = 0; k < 2; ++k) {
    scene.layout.nodes.push_back(scene.layout.nodes[static_cast<size_t>(k)]);
    scene.layout.nodes.back().region = 1;
  }
  TrajectoryRecorder recorder(scene.character, scene.layout, {});
  for (int tick = 0; tick < 4; ++tick)
    recorder.add(scene.frame(rigid(Vector3(0, 0.01 * tick * tick, 0), 0.1 * tick), Vector3::Zero()));
  const std::vector<float> drive =
      recorder.finish({}).need("drive", {4, 4, sinew::tissue::kDriveWidth}).as_f32();
  const auto half = static_cast<std::ptrdiff_t>(2 * sinew::tissue::kDriveWidth);
  const auto last = drive.end() - 2 * half;
  CHECK(std::equal(last, last + half, last + half));
  CHECK(*std::max_element(last, drive.end()) > 0.1f);
}

TEST_CASE("statics_pose_and_optional_tensors_are_there") {
  const Scene scene;
  TrajectoryRecorder recorder(scene.character, scene.layout, {60, true, true});
  recorder.add(scene.frame(rigid(Vector3(5, 6, 7), 0.3), Vector3(0, 0.5, 0)));
  const Safetensors file = recorder.finish({});
  CHECK((at(file.need("node.rest_position", {2, 3}), 3) - Vector3(1, 0, 0)).norm() < kFloat);
  CHECK(file.need("node.stiffness", {2, 1}).as_f32()[1] == 0.25f);
  CHECK(file.need("edges", {1, 2}).as_i32() == std::vector<int32_t>{0, 1});
  CHECK(file.need("joints", {1, 1, 12}).as_f32()[5] == 1);
  CHECK(file.need("root", {1, 7}).as_f32()[2] == 7);
  CHECK(file.need("energy", {1, 2}).as_f32()[0] == 3);
  CHECK(file.need("surface", {1, 2, 3}).as_f32()[1] == 0.5f);
  CHECK(file.need("region.vertices", {2}).as_i32() == std::vector<int32_t>{1, 2});
  CHECK(file.need("carry.0", {2, 2}).as_f32() == std::vector<float>{1, 0, 0, 1});
  CHECK((at(file.need("positions", {1, 3, 3}), 3) - Vector3(0, 1.5, 0)).norm() < kFloat);

  TrajectoryRecorder plain(scene.character, scene.layout, {});
  plain.add(scene.frame(Matrix4::Identity(), Vector3::Zero()));
  CHECK(plain.finish({}).tensors.count("positions") == 0);
}

// trajectory.cpp  What a trajectory file holds is what happened, along each node's frame.
#include "baker/truth/trajectory.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace sinew::baker;
using sinew::tissue::kNodeDriveWidth;

namespace {

constexpr double kTick_s = 1.0 / 60;
constexpr double kFloat = 1e-6;         // rounding of metres to float
constexpr double kAcceleration = 5e-3;  // the same, twice divided by a tick: 1e-7 m x 3600 / s^2, with margin

// Two joints, three vertices, one region of two nodes on the last two; the second one is shared by both
// joints.
struct Scene {
  Character character;
  TissueLayout layout;
  Scene() {
    character.joint_node = {0, 1};
    character.joint_parent = {-1, 0};
    character.inverse_bind = {Matrix4::Identity(), Matrix4::Identity()};
    character.positions = {Vector3(0, 0, 0), Vector3(0, 1, 0), Vector3(0.2, 1, 0)};
    character.normals.assign(3, Vector3::UnitX());
    character.skin.resize(3);
    for (Influences& skin : character.skin) skin.weight[0] = 1;
    character.skin[2].joint = {0, 1};
    character.skin[2].weight = {0.5, 0.5};
    Region region;
    region.node_count = 2;
    region.vertices = {1, 2};
    region.carry = {{1, 0}, {0, 1}};
    region.center = Vector3(0.1, 1, 0);
    region.radius_m = 0.1;
    layout.regions = {region};
    for (const size_t v : {size_t{1}, size_t{2}})
      layout.nodes.push_back(
          {static_cast<int>(v), 0, character.positions[v], character.normals[v], 0.25, character.skin[v]});
    layout.edges = {{0, 1}};
  }

  // None but where the regions are held: at their first node.
  std::vector<ModalBasis> modes() const { return std::vector<ModalBasis>(layout.regions.size()); }

  // The root at `root`, the second joint turned about Z, every vertex `offset` (world) from where skinning
  // puts it.
  TruthFrame frame(const Matrix4& root, const Vector3& offset, double bend = 0) const {
    TruthFrame out;
    Matrix4 bent = Matrix4::Identity();
    bent.topLeftCorner<3, 3>() = Eigen::AngleAxisd(bend, Vector3::UnitZ()).toRotationMatrix();
    out.pose.joints = {Matrix4::Identity(), bent};
    out.pose.root = root;
    for (size_t v = 0; v < character.positions.size(); ++v) {
      Matrix4 matrix = Matrix4::Zero();
      for (size_t k = 0; k < kInfluences; ++k)
        matrix +=
            character.skin[v].weight[k] * out.pose.joints[static_cast<size_t>(character.skin[v].joint[k])];
      out.skinned.push_back((root * matrix * character.positions[v].homogeneous()).head<3>());
      out.truth.push_back(out.skinned.back() + offset);
    }
    out.elastic_energy_j = 3;
    return out;
  }
};

ModalBasis one_mode() {
  ModalBasis basis;
  basis.rad_per_s = basis.damping_ratio = Eigen::VectorXd::Constant(1, 12);
  basis.damping_ratio[0] = 0.1;
  basis.shape = Eigen::VectorXd::LinSpaced(6, 1, 6);
  basis.turn = 2 * basis.shape;
  basis.force = 3 * basis.shape.transpose();
  basis.rest = Eigen::MatrixXd::Identity(6, 6);
  basis.rest(0, 5) = 7;
  basis.rest_rad_per_s = 40;
  basis.rest_damping_ratio = 0.5;
  basis.first_rad_per_s = 11;
  basis.first_damping_ratio = 0.2;
  return basis;
}

Matrix4 rigid(const Vector3& place, double turn_about_y) {
  Matrix4 out = Matrix4::Identity();
  out.topLeftCorner<3, 3>() = Eigen::AngleAxisd(turn_about_y, Vector3::UnitY()).toRotationMatrix();
  out.topRightCorner<3, 1>() = place;
  return out;
}

using Values = std::vector<float>;

Vector3 at(const Values& v, size_t first) { return {v[first], v[first + 1], v[first + 2]}; }
Vector3 at(const Tensor& tensor, size_t first) { return at(tensor.as_f32(), first); }

// The drive of every tick, of a scene without displacement.
template <class RootAt>
Values drive_of(const Scene& scene, int ticks, const RootAt& root_at) {
  TrajectoryRecorder recorder(scene.character, scene.layout, {}, scene.modes());
  for (int tick = 0; tick < ticks; ++tick) recorder.add(scene.frame(root_at(tick), Vector3::Zero()));
  return recorder.finish({}).need("drive", {ticks, std::ssize(scene.layout.nodes), kNodeDriveWidth}).as_f32();
}

}  // namespace

TEST_CASE("displacement_lies_along_each_nodes_own_frame") {
  const Scene scene;
  TrajectoryRecorder recorder(scene.character, scene.layout, {}, scene.modes());
  const double quarter = std::acos(0.0);
  recorder.add(scene.frame(rigid(Vector3(1000, 0, 0), quarter), Vector3(0.01, 0.02, 0), quarter));
  const Safetensors file = recorder.finish({{"motion", "none"}});
  const Tensor& displacement = file.need("displacement", {1, 2, 3});
  // A quarter turn about Y takes the first node's Z to the world's X.
  CHECK((at(displacement, 0) - Vector3(0, 0.02, 0.01)).norm() < kFloat);
  // The flesh of the second is half way to the bent joint, turned by an eighth more about its Z; its frame by
  // three quarters of that.
  const double bend = 0.75 * quarter / 2;
  CHECK((at(displacement, 3) - Vector3(0.02 * std::sin(bend), 0.02 * std::cos(bend), 0.01)).norm() < kFloat);
  CHECK((at(file.need("drive", {1, 2, kNodeDriveWidth}), kNodeDriveWidth + 12) - Vector3(0, 0, quarter / 8))
            .norm() < kFloat);
  CHECK(file.metadata.at("sinew.trajectory") == "5");
  CHECK(file.metadata.at("motion") == "none");
}

TEST_CASE("displacement_turned_back_by_the_nodes_frames_gives_the_truth") {
  const Scene scene;
  const TruthFrame frame = scene.frame(rigid(Vector3(1, 2, 3), 0.7), Vector3(0.03, -0.02, 0.01), 1.1);
  TrajectoryRecorder recorder(scene.character, scene.layout, {}, scene.modes());
  recorder.add(frame);
  const Safetensors file = recorder.finish({});
  const Values rotation = file.need("rotation", {1, 2, 9}).as_f32();
  for (size_t n = 0; n < 2; ++n) {
    const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> axes(&rotation[9 * n]);
    const auto v = static_cast<size_t>(scene.layout.nodes[n].vertex);
    const Vector3 u = at(file.need("displacement", {1, 2, 3}), 3 * n);
    CHECK((axes.transpose() * axes - Eigen::Matrix3f::Identity()).norm() < kFloat);
    CHECK((frame.skinned[v] + axes.cast<double>() * u - frame.truth[v]).norm() < kFloat);
  }
}

TEST_CASE("the_drive_of_a_still_character_is_zero") {
  const Scene scene;
  for (const float value : drive_of(scene, 4, [](int) { return rigid(Vector3(1e4, -20, 3), 0); }))
    CHECK(value == 0);
}

TEST_CASE("an_evenly_accelerated_root_is_felt_as_minus_its_acceleration_in_node_axes") {
  const Scene scene;
  const Vector3 acceleration(3, 0, -1);
  const double turned = 0.8;  // standing: what a turn about Y does to gravity is nothing
  const Values drive = drive_of(scene, 5, [&](int tick) {
    const double t = tick * kTick_s;
    return rigid(acceleration * t * t / 2, turned);
  });
  const size_t row = 2 * kNodeDriveWidth;
  const Vector3 felt = -(Eigen::AngleAxisd(-turned, Vector3::UnitY()) * acceleration);
  CHECK(at(drive, 0).norm() == 0);
  for (size_t n = 0; n < 2; ++n) {
    CHECK((at(drive, 4 * row + n * kNodeDriveWidth) - felt).norm() < kAcceleration);
    for (size_t rest = 3; rest < kNodeDriveWidth; rest += 3)
      CHECK(at(drive, 4 * row + n * kNodeDriveWidth + rest).norm() < kAcceleration);
  }
}

TEST_CASE("a_steady_turn_is_felt_as_its_rate_and_its_centrifugal_pull") {
  const Scene scene;
  const double rate = 1.5;
  const Values drive =
      drive_of(scene, 5, [&](int tick) { return rigid(Vector3::Zero(), rate * tick * kTick_s); });
  const size_t second = (4 * 2 + 1) * kNodeDriveWidth;  // the node 0.2 m from the axis
  const double per_tick = std::sin(rate * kTick_s) / kTick_s;
  CHECK((at(drive, second + 6) - Vector3(0, per_tick, 0)).norm() < kAcceleration);
  CHECK(at(drive, second + 9).norm() < 10 * kAcceleration);
  // Of three places on a circle, seen from the last: the middle one's second difference.
  const double chord = 2 * 0.2 * (1 - std::cos(rate * kTick_s)) / (kTick_s * kTick_s);
  const Vector3 pull(chord * std::cos(rate * kTick_s), 0, chord * std::sin(rate * kTick_s));
  CHECK((at(drive, second) - pull).norm() < kAcceleration);
}

TEST_CASE("the_second_region_keeps_its_own_history") {
  Scene scene;
  Region second = scene.layout.regions[0];
  second.first_node = 2;
  scene.layout.regions.push_back(second);
  for (size_t k = 0; k < 2; ++k) {
    scene.layout.nodes.push_back(scene.layout.nodes[k]);
    scene.layout.nodes.back().region = 1;
  }
  const Values drive =
      drive_of(scene, 4, [](int tick) { return rigid(Vector3(0, 0.01 * tick * tick, 0), 0.1 * tick); });
  const auto half = static_cast<std::ptrdiff_t>(2 * kNodeDriveWidth);
  const auto last = drive.end() - 2 * half;
  CHECK(std::equal(last, last + half, last + half));
  CHECK(*std::max_element(last, drive.end()) > 0.1f);
}

TEST_CASE("the_modes_are_written_region_by_region") {
  const Scene scene;
  TrajectoryRecorder recorder(scene.character, scene.layout, {}, {one_mode()});
  recorder.add(scene.frame(Matrix4::Identity(), Vector3::Zero()));
  const Safetensors file = recorder.finish({});
  CHECK(file.need("modes.0.rad_per_s", {1, 1}).as_f32() == Values{12});
  CHECK(file.need("modes.0.damping_ratio", {1, 1}).as_f32() == Values{0.1f});
  CHECK(file.need("modes.0.shape", {6, 1}).as_f32() == Values{1, 2, 3, 4, 5, 6});
  CHECK(file.need("modes.0.turn", {6, 1}).as_f32() == Values{2, 4, 6, 8, 10, 12});
  CHECK(file.need("modes.0.force", {1, 6}).as_f32() == Values{3, 6, 9, 12, 15, 18});
  CHECK(file.need("modes.0.rest", {6, 6}).as_f32()[5] == 7);
  CHECK(file.need("modes.0.rest_oscillator", {1, 2}).as_f32() == Values{40, 0.5f});
  CHECK(file.need("modes.0.first", {1, 2}).as_f32() == Values{11, 0.2f});
}

TEST_CASE("statics_pose_and_optional_tensors_are_there") {
  const Scene scene;
  TrajectoryRecorder recorder(scene.character, scene.layout, {60, true, true}, scene.modes());
  recorder.add(scene.frame(rigid(Vector3(5, 6, 7), 0.3), Vector3(0, 0.5, 0)));
  const Safetensors file = recorder.finish({});
  CHECK((at(file.need("node.rest_position", {2, 3}), 3) - Vector3(1, 0, 0)).norm() < kFloat);
  CHECK(file.need("node.stiffness", {2, 1}).as_f32()[1] == 0.25f);
  CHECK(file.need("edges", {1, 2}).as_i32() == std::vector<int32_t>{0, 1});
  CHECK(file.need("joints", {1, 2, 12}).as_f32()[5] == 1);
  CHECK(file.need("root", {1, 7}).as_f32()[2] == 7);
  CHECK(file.need("energy", {1, 2}).as_f32()[0] == 3);
  CHECK(file.need("surface", {1, 2, 3}).as_f32()[1] == 0.5f);
  CHECK(file.need("region.vertices", {2}).as_i32() == std::vector<int32_t>{1, 2});
  CHECK(file.need("carry.0", {2, 2}).as_f32() == std::vector<float>{1, 0, 0, 1});
  CHECK((at(file.need("positions", {1, 3, 3}), 3) - Vector3(0, 1.5, 0)).norm() < kFloat);

  TrajectoryRecorder plain(scene.character, scene.layout, {}, scene.modes());
  plain.add(scene.frame(Matrix4::Identity(), Vector3::Zero()));
  CHECK(plain.finish({}).tensors.count("positions") == 0);
}

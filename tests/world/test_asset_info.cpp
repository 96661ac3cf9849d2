// test_asset_info.cpp  What an engine is told of a character: enough to map its own skeleton and meshes to
// it.
#include <array>
#include <limits>
#include <numbers>
#include <string>

#include "pack/reader.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const scenes::PackBytes& clip_pack() {
  static const scenes::PackBytes pack = scenes::soft_block({.network = false, .clip = true});
  return pack;
}

const scenes::PackBytes& armed_pack() {
  static const scenes::PackBytes pack = scenes::soft_block({.network = false, .arms = scenes::ArmMatter{}});
  return pack;
}

std::string path_of(const Stage& stage, uint32_t joint) {
  std::array<char, 256> path;
  const size_t length = stage.world.joint_path(stage.asset, joint, path);
  REQUIRE(length < path.size());
  CHECK(std::string(path.data()).size() == length);
  return path.data();
}

std::vector<Matrix34> sampled(const Stage& stage, double time_s, ClipEnd end = ClipEnd::kHold) {
  std::vector<Matrix34> joints(stage.info.joint_count);
  REQUIRE(stage.world.sample_clip(stage.asset, 0, time_s, end, joints).ok());
  return joints;
}

// About z, of the upper joint.
double angle_rad(const std::vector<Matrix34>& joints) {
  return std::atan2(joints[1].m[1][0], joints[1].m[0][0]);
}

}  // namespace

TEST_CASE("what_an_asset_does_not_have_is_refused_by_its_name") {
  const Stage stage(1, {}, clip_pack());
  const World& world = stage.world;
  MeshInfo mesh{.name = "untouched"};
  PrimitiveInfo primitive;
  JointInfo joint;
  RegionInfo region;
  RodInfo rod;
  ProxyInfo proxy;
  ClipInfo clip;
  const auto refuses = [](const Status& status, const char* what) {
    CHECK(status.code == StatusCode::kInvalidArgument);
    CHECK_THAT(status.message, Catch::Contains(what));
  };
  refuses(world.mesh_info(stage.asset, stage.info.mesh_count, &mesh), "mesh_info: mesh 1");
  CHECK(std::string(mesh.name) == "untouched");
  refuses(world.primitive_info(stage.asset, kNone, &primitive), "primitive_info: primitive 4294967295");
  refuses(world.joint_info(stage.asset, stage.info.joint_count, &joint), "joint_info: joint 2");
  refuses(world.region_info(stage.asset, stage.info.region_count, &region), "region_info: region");
  refuses(world.rod_info(stage.asset, 0, &rod), "the asset has 0");
  refuses(world.proxy_info(stage.asset, 0, &proxy), "the asset has 0");
  refuses(world.clip_info(stage.asset, 1, &clip), "clip_info: clip 1");
  refuses(world.joint_info(stage.asset, 0, nullptr), "null");
  refuses(world.asset_arrays(stage.asset, nullptr), "null");
  CHECK(world.joint_info({}, 0, &joint).code == StatusCode::kStaleId);
  CHECK(world.joint_path({}, 0, {}) == 0);
  CHECK(world.joint_path(stage.asset, stage.info.joint_count, {}) == 0);
}

TEST_CASE("a_clip_refuses_what_is_no_time_and_no_room") {
  const Stage stage(1, {}, clip_pack());
  std::vector<Matrix34> joints(stage.info.joint_count), fewer(1);
  const auto sample = [&](uint32_t clip, double time_s, ClipEnd end, std::span<Matrix34> out) {
    return stage.world.sample_clip(stage.asset, clip, time_s, end, out).code;
  };
  CHECK(sample(1, 0, ClipEnd::kHold, joints) == StatusCode::kInvalidArgument);
  CHECK(sample(0, kNan, ClipEnd::kHold, joints) == StatusCode::kNotFinite);
  CHECK(sample(0, 0, static_cast<ClipEnd>(2), joints) == StatusCode::kInvalidArgument);
  CHECK(sample(0, 0, ClipEnd::kHold, fewer) == StatusCode::kInvalidArgument);
  for (const double far_s : {1e300, -1e300, std::numeric_limits<double>::max()})
    for (const ClipEnd end : {ClipEnd::kHold, ClipEnd::kLoop})
      CHECK(sample(0, far_s, end, joints) == StatusCode::kOk);
}

TEST_CASE("arrays_are_those_of_the_pack") {
  const Stage stage(1, {}, armed_pack());
  pack::PackView pack;
  REQUIRE(pack::open_pack(armed_pack().bytes(), &pack).ok());
  AssetArrays arrays;
  REQUIRE(stage.world.asset_arrays(stage.asset, &arrays).ok());
  CHECK(arrays.positions_m.data() == pack.positions.data());
  CHECK(arrays.positions_m.size() == 3 * stage.info.vertex_count);
  CHECK(arrays.normals.data() == pack.normals.data());
  CHECK(arrays.triangles.size() == 3 * stage.info.triangle_count);
  const auto* joints =
      reinterpret_cast<const uint16_t*>(reinterpret_cast<const char*>(arrays.skin_joints) +
                                        (stage.info.vertex_count - 1) * arrays.skin_stride_bytes);
  CHECK(joints == pack.skin.back().joint);
}

TEST_CASE("meshes_are_made_of_primitives_that_cover_them") {
  const Stage stage;
  CHECK(stage.info.unit_m == 1);
  uint32_t vertices = 0, triangles = 0, primitives = 0;
  for (uint32_t m = 0; m < stage.info.mesh_count; ++m) {
    MeshInfo mesh;
    REQUIRE(stage.world.mesh_info(stage.asset, m, &mesh).ok());
    CHECK(mesh.first_primitive == primitives);
    for (uint32_t p = 0; p < mesh.primitive_count; ++p, ++primitives) {
      PrimitiveInfo primitive;
      REQUIRE(stage.world.primitive_info(stage.asset, primitives, &primitive).ok());
      CHECK(primitive.mesh == m);
      CHECK(primitive.first_vertex == vertices);
      CHECK(primitive.first_triangle == triangles);
      vertices += primitive.vertex_count;
      triangles += primitive.triangle_count;
    }
  }
  CHECK(primitives == stage.info.primitive_count);
  CHECK(vertices == stage.info.vertex_count);
  CHECK(triangles == stage.info.triangle_count);
}

TEST_CASE("moved_vertices_are_those_that_some_region_carries") {
  const scenes::PackBytes bytes = scenes::soft_block({.regions = 2, .network = false});
  const Stage stage(1, {}, bytes);
  std::vector<bool> carried(stage.info.vertex_count);
  for (uint32_t r = 0; r < stage.info.region_count; ++r) {
    RegionInfo region;
    REQUIRE(stage.world.region_info(stage.asset, r, &region).ok());
    for (const uint32_t vertex : region.vertices) carried[vertex] = true;
  }
  AssetArrays arrays;
  REQUIRE(stage.world.asset_arrays(stage.asset, &arrays).ok());
  CHECK(arrays.moved_vertices.size() == stage.info.moved_vertex_count);
  CHECK(std::ranges::is_sorted(arrays.moved_vertices));
  std::vector<bool> moved(stage.info.vertex_count);
  for (const uint32_t vertex : arrays.moved_vertices) moved[vertex] = true;
  CHECK(moved == carried);
}

TEST_CASE("inverse_binds_undo_the_bind_pose_and_parents_come_first") {
  const Stage stage(1, {}, test::tailed_pack());
  std::vector<Matrix34> bind(stage.info.joint_count);
  REQUIRE(stage.world.bind_pose(stage.asset, bind).ok());
  constexpr double kRounding = 1e-6;  // float, a few operations on places below 1 m
  double worst = 0;
  for (uint32_t j = 0; j < stage.info.joint_count; ++j) {
    JointInfo joint;
    REQUIRE(stage.world.joint_info(stage.asset, j, &joint).ok());
    CHECK(std::string(joint.name) == stage.world.joint_name(stage.asset, j));
    CHECK((joint.parent == kNone || joint.parent < j));
    CHECK((joint.rod != kNone) == stage.world.joint_is_on_rod(stage.asset, j));
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) {
        double sum = c == 3 ? static_cast<double>(bind[j].m[r][3]) : 0;
        for (int k = 0; k < 3; ++k)
          sum += static_cast<double>(bind[j].m[r][k]) * static_cast<double>(joint.inverse_bind.m[k][c]);
        worst = std::max(worst, std::abs(sum - (r == c ? 1 : 0)));
      }
  }
  CHECK(worst < kRounding);
}

TEST_CASE("paths_go_from_the_root_and_tell_namesakes_apart") {
  const Stage stage(1, {}, test::tailed_pack());
  std::vector<std::string> paths;
  for (uint32_t j = 0; j < stage.info.joint_count; ++j) {
    JointInfo joint;
    REQUIRE(stage.world.joint_info(stage.asset, j, &joint).ok());
    const std::string path = path_of(stage, j);
    if (joint.parent == kNone)
      CHECK(path == joint.name);
    else
      CHECK(path == path_of(stage, joint.parent) + "/" + joint.name);
    CHECK(std::ranges::find(paths, path) == paths.end());
    paths.push_back(path);
  }
  std::array<char, 4> cut;
  const std::string whole = path_of(stage, 3);
  CHECK(stage.world.joint_path(stage.asset, 3, cut) == whole.size());
  CHECK(std::string(cut.data()) == whole.substr(0, 3));
}

TEST_CASE("rods_and_capsules_tell_what_they_hang_on") {
  const Stage tailed(1, {}, test::tailed_pack()), armed(1, {}, armed_pack());
  for (uint32_t r = 0; r < tailed.info.rod_count; ++r) {
    RodInfo rod;
    REQUIRE(tailed.world.rod_info(tailed.asset, r, &rod).ok());
    CHECK(rod.segment_count > 0);
    CHECK(rod.length_m > 0.1f);
    const float w = 2 * std::numbers::pi_v<float> * rod.frequency_hz;
    CHECK(w > 1);
    CHECK(rod.damping_ratio == Approx(w * 0.01f / 2 + 0.5f / (2 * w)));  // block_rods.cpp
    CHECK(!tailed.world.joint_is_on_rod(tailed.asset, rod.attach_joint));
    CHECK(rod.end_joint == kNone);
  }
  REQUIRE(armed.info.proxy_count > 0);
  ProxyInfo proxy;
  REQUIRE(armed.world.proxy_info(armed.asset, 0, &proxy).ok());
  CHECK(proxy.radius_m > 0);
  CHECK(proxy.joint < armed.info.joint_count);
}

TEST_CASE("regions_tell_their_frequency_and_where_they_are") {
  const Stage stage(1, {}, test::weightless_pack());
  RegionInfo region;
  REQUIRE(stage.world.region_info(stage.asset, 0, &region).ok());
  CHECK(region.frequency_hz == Approx(3.5).epsilon(0.2));  // block_modes.hpp
  CHECK(region.damping_ratio > 0);
  CHECK(region.radius_m > 0.1f);
  CHECK(region.center_m[1] > 0.2f);
  CHECK(region.displacement_limit_m == Approx(0.75 * static_cast<double>(region.radius_m)));
}

TEST_CASE("a_clip_is_its_frames_and_turns_evenly_between_them") {
  const Stage stage(1, {}, clip_pack());
  ClipInfo clip;
  REQUIRE(stage.world.clip_info(stage.asset, 0, &clip).ok());
  CHECK(std::string(clip.name) == "nod");
  CHECK(clip.duration_s == Approx(1));
  constexpr double kRounding_rad = 1e-5;
  for (const double time_s : {0.0, 0.1, 0.3333, 0.5, 0.71, 1.0})
    CHECK(angle_rad(sampled(stage, time_s)) == Approx(time_s).margin(kRounding_rad));
  CHECK(angle_rad(sampled(stage, -3)) == Approx(0).margin(kRounding_rad));
  CHECK(angle_rad(sampled(stage, 7)) == Approx(1).margin(kRounding_rad));
  CHECK(angle_rad(sampled(stage, 7.25, ClipEnd::kLoop)) == Approx(0.25).margin(kRounding_rad));
  CHECK(angle_rad(sampled(stage, -0.25, ClipEnd::kLoop)) == Approx(0.75).margin(kRounding_rad));
}

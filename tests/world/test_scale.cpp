// test_scale.cpp  A character that is larger or smaller than it was baked: what it swings with, shows and
// touches.
#include <limits>

#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::TailedPose;
using test::joints_of;
using test::Stage;
using test::tailed_pack;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr double kScales[] = {0.1, 3, 10};

// The same motion by a character of this size: its travel grows with it.
TailedPose sized(const TailedPose& pose, double scale) {
  TailedPose out = pose;
  out.root.scale = scale;
  for (double& place : out.root.position_m) place *= scale;
  return out;
}

void step(Stage& stage, const TailedPose& pose) {
  REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
  stage.world.step(static_cast<float>(kFrame_s));
}

}  // namespace

TEST_CASE("a_scale_of_none_or_beyond_its_range_is_refused") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const std::vector<std::byte> before = stage.save();
  scenes::BlockPose pose = scenes::walk(1);
  for (const double bad : {0.0, -1.0, 1e-4, 1e4}) {
    pose.root.scale = bad;
    CHECK(stage.world.set_pose(stage.blocks[0], pose.pose()).code == StatusCode::kInvalidArgument);
    InstanceId made;
    CHECK(stage.world.create_instance({.asset = stage.asset, .root = pose.root}, &made).code ==
          StatusCode::kInvalidArgument);
  }
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    pose.root.scale = bad;
    CHECK(stage.world.set_pose(stage.blocks[0], pose.pose()).code == StatusCode::kNotFinite);
  }
  CHECK(stage.save() == before);
}

TEST_CASE("at_every_scale_flesh_and_rods_swing_alike") {
  for (const double scale : kScales) {
    Stage baked(1, {}, tailed_pack()), other(1, {}, tailed_pack());
    double swing_m = 0, apart_m = 0, apart = 0;
    for (int f = 0; f < 180; ++f) {
      const TailedPose pose = scenes::with_rods(scenes::walk(f * kFrame_s));
      step(baked, pose);
      step(other, sized(pose, scale));
      const std::vector<float> own = baked.read(0, Space::kBind);
      swing_m = std::max(swing_m, double{test::largest_length(own)});
      apart_m = std::max(apart_m, double{test::largest_distance(own, other.read(0, Space::kBind))});
      apart = std::max(apart, double{test::largest_distance(joints_of(baked), joints_of(other))});
    }
    CHECK(swing_m > 0.005);
    CHECK(apart_m < 1e-5 * swing_m + 1e-6);  // places in doubles, divided
    CHECK(apart < 1e-3);
  }
}

TEST_CASE("flesh_of_joints_that_scale_swings_alike") {
  for (const double scale : kScales) {
    Stage baked, other;
    double swing_m = 0, apart_m = 0;
    for (int f = 0; f < 180; ++f) {
      const scenes::BlockPose pose = scenes::walk(f * kFrame_s);
      scenes::BlockPose larger = pose;
      for (Matrix34& joint : larger.joints)
        for (auto& row : joint.m)
          for (float& entry : row) entry *= static_cast<float>(scale);
      for (double& place : larger.root.position_m) place *= scale;
      baked.pose(baked.blocks[0], pose);
      other.pose(other.blocks[0], larger);
      baked.world.step(static_cast<float>(kFrame_s));
      other.world.step(static_cast<float>(kFrame_s));
      const std::vector<float> own = baked.read(0, Space::kBind);
      swing_m = std::max(swing_m, double{test::largest_length(own)});
      apart_m = std::max(apart_m, double{test::largest_distance(own, other.read(0, Space::kBind))});
    }
    CHECK(swing_m > 0.005);
    CHECK(apart_m < 0.01 * swing_m);  // places in floats, of characters up to ten times as large
  }
}

TEST_CASE("in_the_world_a_scaled_character_is_as_much_larger") {
  Stage baked, large;
  scenes::BlockPose pose = scenes::bent_pose(0.4, 2, 0.7);
  baked.pose(baked.blocks[0], pose);
  pose.root.scale = 3;
  for (double& place : pose.root.position_m) place *= 3;
  large.pose(large.blocks[0], pose);
  baked.world.step(static_cast<float>(kFrame_s));
  large.world.step(static_cast<float>(kFrame_s));
  const std::vector<float> own = baked.read(0, Space::kWorld), scaled = large.read(0, Space::kWorld);
  for (size_t i = 0; i < own.size(); ++i) CHECK(scaled[i] == Approx(3 * own[i]).margin(1e-5));
  CHECK(baked.read() == large.read());  // of the character's own space
  std::vector<float> normals(own.size());
  const ReadDef def{.space = Space::kWorld, .out = normals.data(), .capacity = large.info.vertex_count};
  REQUIRE(large.world.read_normals(large.blocks[0], def).ok());
  for (size_t i = 0; i < normals.size(); i += 3)
    CHECK(std::hypot(normals[i], normals[i + 1], normals[i + 2]) == Approx(1).margin(1e-4));
}

TEST_CASE("a_scaled_character_touches_what_is_as_far_away_as_it_is_large") {
  for (const double scale : kScales) {
    scenes::HalfSpaces near, far;
    near.walls.push_back({.point_m = {0.2, 0, 0}, .normal = {-1, 0, 0}, .velocity_m_s = {-0.1f, 0, 0}});
    far.walls.push_back({.point_m = {0.2 * scale, 0, 0},
                         .normal = {-1, 0, 0},
                         .velocity_m_s = {static_cast<float>(-0.1 * scale), 0, 0}});
    far.near_m = near.near_m * scale;
    const auto stage_with = [&](scenes::HalfSpaces& walls) {
      auto stage = std::make_unique<Stage>(0, WorldDef{}, tailed_pack());
      InstanceId made;
      REQUIRE(
          stage->world.create_instance({.asset = stage->asset, .contacts = {.source = &walls}}, &made).ok());
      stage->blocks.push_back(made);
      return stage;
    };
    const auto baked = stage_with(near), other = stage_with(far);
    double apart_m = 0, apart = 0;
    uint32_t touched = 0;
    for (int f = 0; f < 120; ++f) {
      const TailedPose pose = scenes::with_rods(scenes::shake(f * kFrame_s, 1.5));
      step(*baked, pose);
      step(*other, sized(pose, scale));
      touched = std::max(touched, other->report().vertices_touched);
      apart_m = std::max(apart_m, double{test::largest_distance(baked->read(0, Space::kBind),
                                                                other->read(0, Space::kBind))});
      apart = std::max(apart, double{test::largest_distance(joints_of(*baked), joints_of(*other))});
    }
    CHECK(touched > 0);
    CHECK(apart_m < 1e-4);
    CHECK(apart < 5e-3);
  }
}

TEST_CASE("a_change_of_scale_is_not_felt") {
  Stage stage(1, {}, tailed_pack());
  const std::vector<float> rest = [&] {
    TailedPose pose = scenes::with_rods(scenes::bind_pose());
    pose.root.position_m[0] = 5;
    for (int f = 0; f < 30; ++f) step(stage, pose);
    return joints_of(stage);
  }();
  for (int f = 0; f < 60; ++f) {
    TailedPose pose = scenes::with_rods(scenes::bind_pose());
    pose.root.scale = f < 20 ? 1 + 0.1 * f : 0.5;  // grows, and shrinks at once
    pose.root.position_m[0] = 5;                   // far enough that its place in its own metres jumps
    step(stage, pose);
    CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-5);
    CHECK(test::largest_distance(joints_of(stage), rest) < 1e-3);
  }
}

TEST_CASE("who_grows_while_it_runs_feels_nothing_of_it") {
  Stage stage;
  double x_m = 0;
  for (int f = -180; f < 90; ++f) {
    const double share = std::clamp((f + 180) / 60.0, 0.0, 1.0);
    x_m += 4 * kFrame_s * share * share * (3 - 2 * share);  // up to 4 m/s
    scenes::BlockPose pose = scenes::bind_pose();
    pose.root.position_m[0] = x_m;
    pose.root.scale = f < 0 ? 1 : f < 30 ? 1 + f / 30.0 : f < 60 ? 2 : 0.5;
    stage.pose(stage.blocks[0], pose);
    stage.world.step(static_cast<float>(kFrame_s));
    if (f >= -10) CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-3);
  }
}

TEST_CASE("the_bound_of_a_scaled_character_is_what_a_view_sees") {
  Stage stage;
  REQUIRE(stage.world.set_time_scale(stage.blocks[0], 1).ok());
  scenes::BlockPose pose = scenes::bind_pose();
  pose.root.position_m[2] = -10;
  const View up{.position_m = {0, 12, 0}, .height_rad = 0.3f};  // along -Z, above a small block
  const auto hidden = [&](double scale) {
    pose.root.scale = scale;
    for (int f = 0; f < 20; ++f) {
      stage.pose(stage.blocks[0], pose);
      REQUIRE(stage.world.set_views({&up, 1}).ok());
      stage.world.step(static_cast<float>(kFrame_s));
    }
    return stage.report().hidden;
  };
  CHECK(hidden(1));
  CHECK_FALSE(hidden(25));
}

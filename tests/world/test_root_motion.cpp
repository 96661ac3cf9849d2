// test_root_motion.cpp  What of its root's motion a character feels: a share of it, and nothing of what it
// rides on.
#include <limits>

#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::BlockPose;
using scenes::TailedPose;
using test::joints_of;
using test::Stage;
using test::tailed_pack;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A lift that starts and stops, and a carousel of two metres' radius.
RootTransform lift(double t) {
  RootTransform root;
  root.position_m[1] = 2 * std::sin(3 * t);
  return root;
}
RootTransform carousel(double t) {
  RootTransform root;
  const double angle = 1.5 * std::sin(2 * t);
  root.rotation_xyzw[1] = static_cast<float>(std::sin(angle / 2));
  root.rotation_xyzw[3] = static_cast<float>(std::cos(angle / 2));
  root.position_m[0] = 2 * std::cos(angle);
  root.position_m[2] = -2 * std::sin(angle);
  return root;
}

// Where the character is in the world that has this place in the space.
RootTransform within(const RootTransform& space, const RootTransform& root) {
  const float* q = space.rotation_xyzw;  // about the upright
  const double c = 1 - 2.0 * q[1] * q[1], s = 2.0 * q[1] * q[3];
  RootTransform out = root;
  out.position_m[0] = space.position_m[0] + c * root.position_m[0] + s * root.position_m[2];
  out.position_m[1] = space.position_m[1] + root.position_m[1];
  out.position_m[2] = space.position_m[2] - s * root.position_m[0] + c * root.position_m[2];
  const float* r = root.rotation_xyzw;
  out.rotation_xyzw[1] = q[3] * r[1] + q[1] * r[3];
  out.rotation_xyzw[3] = q[3] * r[3] - q[1] * r[1];
  return out;
}

}  // namespace

TEST_CASE("a_share_of_root_motion_that_is_none_is_refused") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const std::vector<std::byte> before = stage.save();
  CHECK(stage.world.set_felt_root_motion(stage.blocks[0], kNan).code == StatusCode::kNotFinite);
  for (const float bad : {-0.1f, 1.1f, INFINITY})
    CHECK(stage.world.set_felt_root_motion(stage.blocks[0], bad).code == StatusCode::kInvalidArgument);
  CHECK(stage.world.set_felt_root_motion({}, 0.5f).code == StatusCode::kStaleId);
  CHECK(stage.save() == before);
}

TEST_CASE("a_space_that_is_none_is_refused_and_the_last_pose_stays") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const std::vector<std::byte> before = stage.save();
  const BlockPose block = scenes::walk(1);
  Pose pose = block.pose();
  pose.space = {.id = 1};
  pose.space.root.rotation_xyzw[3] = 0;
  CHECK(stage.world.set_pose(stage.blocks[0], pose).code == StatusCode::kInvalidArgument);
  pose.space.root.position_m[0] = kNan;
  CHECK(stage.world.set_pose(stage.blocks[0], pose).code == StatusCode::kNotFinite);
  CHECK(stage.save() == before);
}

TEST_CASE("root_motion_that_is_not_felt_moves_nothing") {
  Stage stage(1, {}, tailed_pack());
  REQUIRE(stage.world.set_felt_root_motion(stage.blocks[0], 0).ok());
  std::vector<float> first;
  for (int f = 0; f < 180; ++f) {
    TailedPose pose = scenes::with_rods(scenes::bind_pose());
    pose.root = carousel(f * kFrame_s);
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
    stage.world.step(static_cast<float>(kFrame_s));
    if (f == 0) first = joints_of(stage);
    CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-5);
    CHECK(test::largest_distance(joints_of(stage), first) < 1e-3);
  }
}

TEST_CASE("half_of_the_root_s_motion_feels_as_a_motion_half_as_long") {
  const auto hop = [](double reach_m) {
    return [=](double t) {
      BlockPose pose = scenes::bind_pose();
      pose.root.position_m[1] = reach_m * (1 - std::cos(9 * t));
      return pose;
    };
  };
  Stage half, shared;
  REQUIRE(shared.world.set_felt_root_motion(shared.blocks[0], 0.5f).ok());
  double swing_m = 0, apart_m = 0;
  for (int f = 0; f < 180; ++f) {
    half.step(hop(0.02), kFrame_s);
    shared.step(hop(0.04), kFrame_s);
    swing_m = std::max(swing_m, double{test::largest_length(half.read(0, Space::kBind))});
    apart_m = std::max(
        apart_m, double{test::largest_distance(half.read(0, Space::kBind), shared.read(0, Space::kBind))});
  }
  CHECK(swing_m > 0.002);
  CHECK(apart_m < 1e-5);
}

TEST_CASE("what_a_character_rides_on_is_not_felt_and_its_own_motion_is") {
  for (const auto ride : {lift, carousel}) {
    Stage walking(1, {}, tailed_pack()), riding(1, {}, tailed_pack()), felt(1, {}, tailed_pack());
    double swing_m = 0, apart_m = 0, apart = 0, felt_m = 0;
    for (int f = 0; f < 240; ++f) {
      const double t = f * kFrame_s;
      TailedPose pose = scenes::with_rods(scenes::shake(t, 1));
      const auto step = [&](Stage& stage, const RootTransform& root, const RiddenSpace& space) {
        Pose given = pose.pose();
        given.root = root;
        given.space = space;
        REQUIRE(stage.world.set_pose(stage.blocks[0], given).ok());
        stage.world.step(static_cast<float>(kFrame_s));
      };
      step(walking, pose.root, {});
      step(riding, within(ride(t), pose.root), {.id = 7, .root = ride(t)});
      step(felt, within(ride(t), pose.root), {});
      const std::vector<float> own = walking.read(0, Space::kBind);
      swing_m = std::max(swing_m, double{test::largest_length(own)});
      apart_m = std::max(apart_m, double{test::largest_distance(own, riding.read(0, Space::kBind))});
      felt_m = std::max(felt_m, double{test::largest_distance(own, felt.read(0, Space::kBind))});
      apart = std::max(apart, double{test::largest_distance(joints_of(walking), joints_of(riding))});
    }
    CHECK(swing_m > 0.005);
    CHECK(felt_m > 0.3 * swing_m);
    // Floats of places metres away, turned each frame.
    CHECK(apart_m < 0.01 * swing_m);
    CHECK(apart < 0.02);
  }
}

TEST_CASE("who_gets_on_or_off_feels_its_own_way_alone") {
  Stage stage;
  const auto step = [&](const RootTransform& root, uint32_t id, double t) {
    const BlockPose block = scenes::bind_pose();
    Pose pose = block.pose();
    pose.root = root;
    pose.space = {.id = id, .root = lift(t)};
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose).ok());
    stage.world.step(static_cast<float>(kFrame_s));
    return test::largest_length(stage.read(0, Space::kBind));
  };
  for (int f = 0; f < 60; ++f) CHECK(step({}, 0, 0) == 0);
  for (int f = 0; f < 60; ++f) CHECK(step({}, 3, 0) < 1e-6);  // of a lift that stands
  for (int f = 0; f < 60; ++f) CHECK(step(within(lift(f * kFrame_s), {}), 3, f * kFrame_s) < 1e-5);
  CHECK(stage.report().teleports == 0);
}

TEST_CASE("who_boards_and_leaves_what_moves_evenly_feels_nothing") {
  Stage stage;
  double x_m = 0;
  for (int f = -180; f < 180; ++f) {
    const double share = std::clamp((f + 180) / 60.0, 0.0, 1.0);
    x_m += 4 * kFrame_s * share * share * (3 - 2 * share);
    BlockPose pose = scenes::bind_pose();
    pose.root.position_m[0] = x_m;
    Pose given = pose.pose();
    given.space = {.id = f >= 60 && f < 120 ? 4u : 0u, .root = pose.root};
    REQUIRE(stage.world.set_pose(stage.blocks[0], given).ok());
    stage.world.step(static_cast<float>(kFrame_s));
    if (f >= 50) CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-4);
  }
}

// A pause in the midst of it, a share that is felt, a cut on leaving; rods swing on.
TEST_CASE("who_boards_and_leaves_keeps_the_swing_of_its_rods") {
  for (const bool pauses : {false, true}) {
    Stage riding(1, {}, tailed_pack()), usual(1, {}, tailed_pack());
    double apart = 0, swing = 0;
    const std::vector<float> rest = joints_of(usual);
    for (int f = 0; f < 120; ++f) {
      const double t = f * kFrame_s, x_m = 4 * std::max(0.0, t - 0.25);
      const TailedPose own = scenes::with_rods(scenes::shake(t, 2));
      const auto step = [&](Stage& stage, uint32_t id, double dt_s) {
        Pose pose = own.pose();
        pose.root.position_m[0] = own.root.position_m[0] + (&stage == &riding ? x_m : 0);
        pose.space.id = id;
        pose.space.root.position_m[0] = x_m;
        REQUIRE(stage.world.set_pose(stage.blocks[0], pose).ok());
        stage.world.step(static_cast<float>(dt_s));
      };
      step(usual, 0, kFrame_s);
      // It rides all the while, on one vehicle after the other.
      step(riding, f < 60 ? 1 : f < 90 ? 2 : 3, kFrame_s);
      if (pauses && f % 30 == 0) step(riding, f < 60 ? 1 : f < 90 ? 2 : 3, 0);
      apart = std::max(apart, double{test::largest_distance(joints_of(usual), joints_of(riding))});
      swing = std::max(swing, double{test::largest_distance(joints_of(usual), rest)});
    }
    CHECK(swing > 0.1);
    // Air blows for the step between two vehicles.
    CHECK(apart < 0.1 * swing);
    CHECK(riding.report().teleports == 0);
  }
}

TEST_CASE("a_cut_on_leaving_what_one_rides_on_is_a_cut") {
  for (const bool told : {false, true}) {
    Stage stage;
    for (int f = 0; f < 120; ++f) {
      scenes::BlockPose own = scenes::bind_pose();
      Pose pose = own.pose();
      const double x_m = 2 * f * kFrame_s;
      pose.space = {.id = f < 60 ? 8u : 0u};
      pose.space.root.position_m[0] = x_m;
      pose.root.position_m[0] = f < 60 ? x_m : 1;
      pose.root.position_m[1] = f < 60 ? 0 : 1.5;
      pose.teleport = told && f == 60;
      REQUIRE(stage.world.set_pose(stage.blocks[0], pose).ok());
      stage.world.step(static_cast<float>(kFrame_s));
      if (f >= 60) CHECK(test::largest_length(stage.read(0, Space::kBind)) < 5e-4);
    }
    CHECK(stage.report().teleports == 1);
  }
}

TEST_CASE("who_rides_at_rest_falls_dormant_and_is_taken_along") {
  Stage stage;
  const auto step = [&](uint32_t id, double up_m) {
    const BlockPose block = scenes::bind_pose();
    Pose pose = block.pose();
    pose.root.position_m[1] = up_m;
    pose.space.id = id;
    pose.space.root.position_m[1] = up_m;
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose).ok());
    stage.world.step(static_cast<float>(kFrame_s));
  };
  for (int f = 0; f < 200; ++f) step(5, 0);
  CHECK(stage.report().dormant);
  const std::vector<float> before = stage.read(0, Space::kWorld);
  step(5, 0.01);
  const std::vector<float> after = stage.read(0, Space::kWorld);
  for (size_t i = 1; i < after.size(); i += 3) CHECK(after[i] == Approx(before[i] + 0.01).margin(1e-6));
  step(5, 0.01);  // the lift stands
  step(0, 0.01);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-5);
}

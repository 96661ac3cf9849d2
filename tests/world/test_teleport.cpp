// test_teleport.cpp  What goes further in a step than motion does is carried, and told.
#include <limits>
#include <numbers>

#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::BlockPose;
using scenes::TailedPose;
using test::Stage;
using test::tailed_pack;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr TeleportDef kNothingIs{kNever, kNever, kNever, kNever};
// Metres: of the block's 0.6 m what is no motion of its flesh; below what anybody sees.
constexpr double kCarried_m = 0.0005, kFelt_m = 0.005;

double shape_m(const Stage& stage) { return test::largest_length(stage.read(0, Space::kBind)); }

// The largest displacement in a second of frames after the block stood for one, then was posed like this.
double after_m(Stage& stage, const BlockPose& before, const BlockPose& after, double fps = 60) {
  stage.play([&](double) { return before; }, 1, fps);
  double most_m = 0;
  for (int f = 0; f < static_cast<int>(fps); ++f) {
    stage.step([&](double) { return after; }, 1 / fps);
    most_m = std::max(most_m, shape_m(stage));
  }
  return most_m;
}

BlockPose turned(double heading_rad) { return scenes::bent_pose(0, 0, heading_rad); }

BlockPose raised(double y_m) {
  BlockPose pose = scenes::bind_pose();
  pose.root.position_m[1] = y_m;
  return pose;
}

// Of the upper joint alone, which the flesh hangs on.
BlockPose with_joint(float y_m, float size) {
  BlockPose pose = scenes::bind_pose();
  Matrix34& joint = pose.joints[1];
  for (auto& row : joint.m)
    for (int k = 0; k < 3; ++k) row[k] *= size;
  joint.m[1][3] += y_m;
  return pose;
}

// About the upright, so that gravity pulls as it did.
BlockPose with_turned_joint(float angle_rad) {
  BlockPose pose = scenes::bind_pose();
  const float c = std::cos(angle_rad), s = std::sin(angle_rad), y_m = pose.joints[1].m[1][3];
  pose.joints[1] = {{{c, 0, s, 0}, {0, 1, 0, y_m}, {-s, 0, c, 0}}};
  return pose;
}

struct Jump {
  const char* name;
  BlockPose after;
};
std::vector<Jump> jumps() {
  BlockPose travelled = scenes::bind_pose();
  for (Matrix34& joint : travelled.joints) joint.m[2][3] += 1.5f;
  return {{"a snap turn of 45 degrees", turned(std::numbers::pi / 4)},
          {"a snap turn of 180 degrees", turned(std::numbers::pi)},
          {"a step up", raised(0.25)},
          {"a kilometre", scenes::bent_pose(0, 1000)},
          {"all joints travel", travelled},
          {"a joint turns", with_turned_joint(1)},
          {"a joint jumps", with_joint(0.2f, 1)},
          {"a joint doubles", with_joint(0, 2)},
          {"a joint halves", with_joint(0, 0.5f)}};
}

}  // namespace

TEST_CASE("what_jumps_is_carried_at_every_frame_rate") {
  for (const double fps : {60.0, 240.0}) {
    for (const Jump& jump : jumps()) {
      INFO(jump.name << " at " << fps << " frames a second");
      Stage carried, felt(1, {.teleport = kNothingIs});
      CHECK(after_m(carried, scenes::bind_pose(), jump.after, fps) < kCarried_m);
      CHECK(after_m(felt, scenes::bind_pose(), jump.after, fps) > kFelt_m);
    }
  }
}

TEST_CASE("what_jumps_back_is_carried_as_well") {
  for (const Jump& jump : jumps()) {
    INFO(jump.name);
    Stage stage;
    (void)after_m(stage, scenes::bind_pose(), jump.after);
    CHECK(after_m(stage, jump.after, scenes::bind_pose()) < kCarried_m);
  }
}

TEST_CASE("a_report_counts_teleports_of_the_root_and_of_parts") {
  Stage stage;
  (void)after_m(stage, scenes::bind_pose(), turned(1));
  CHECK(stage.report().teleports == 1);
  CHECK(stage.report().part_teleports == 0);
  (void)after_m(stage, turned(1), scenes::bent_pose(1.2, 0, 1));
  CHECK(stage.report().teleports == 1);
  CHECK(stage.report().part_teleports == 2);  // both regions hang on the joint
}

TEST_CASE("a_pose_that_says_so_teleports_however_near_it_is") {
  const auto jolted_m = [](bool teleport) {
    Stage stage;
    stage.play([](double) { return scenes::bind_pose(); }, 0.5);
    const scenes::BlockPose bound = scenes::bind_pose();
    Pose pose = bound.pose();
    pose.root.position_m[1] = 0.06;
    pose.teleport = teleport;
    double most_m = 0;
    for (int f = 0; f < 60; ++f, pose.teleport = false) {
      REQUIRE(stage.world.set_pose(stage.blocks[0], pose).ok());
      stage.world.step(static_cast<float>(kFrame_s));
      most_m = std::max(most_m, shape_m(stage));
    }
    CHECK(stage.report().teleports == (teleport ? 1 : 0));
    return most_m;
  };
  CHECK(jolted_m(false) > kFelt_m);
  CHECK(jolted_m(true) < kCarried_m);
}

TEST_CASE("what_moves_while_no_time_passes_is_carried") {
  Stage stage;
  stage.play([](double) { return scenes::bind_pose(); }, 0.5);
  for (int f = 1; f <= 20; ++f) {
    stage.pose(stage.blocks[0], raised(0.01 * f));
    stage.world.step(0);
  }
  CHECK(after_m(stage, raised(0.2), raised(0.2)) < kCarried_m);
}

// Three metres a second against the block's 0.09 m a step: a dash of a tenth of a second, and what it swings
// with when it is cut off.
TEST_CASE("a_dash_is_felt_and_a_cut_in_its_midst_keeps_the_swing") {
  const auto dash = [](double t) {
    const double s = std::clamp(t - 0.5, 0.0, 0.1);
    return scenes::bent_pose(0, 3 * (s * s / 0.2 + std::max(0.0, t - 0.6)));
  };
  const auto cut = [&](double t) {
    BlockPose pose = dash(t);
    if (t > 0.7) pose.root.position_m[2] = -50;
    return pose;
  };
  Stage running, jumping, felt(1, {.teleport = kNothingIs});
  double apart_m = 0, swing_m = 0;
  for (int f = 0; f < 90; ++f) {
    running.step(dash, kFrame_s);
    felt.step(dash, kFrame_s);
    jumping.step(cut, kFrame_s);
    const std::vector<float> own = running.read(0, Space::kBind);
    CHECK(own == felt.read(0, Space::kBind));
    swing_m = std::max(swing_m, test::largest_length(own));
    apart_m = std::max(apart_m, test::largest_distance(own, jumping.read(0, Space::kBind)));
  }
  CHECK(running.report().teleports == 0);
  CHECK(jumping.report().teleports == 1);
  CHECK(swing_m > kFelt_m);
  CHECK(apart_m < 0.02 * swing_m);
}

TEST_CASE("a_stop_is_felt_by_no_more_than_its_bound") {
  const auto stop = [](double t) { return scenes::bent_pose(0, 4 * std::min(t - 1, 0.0)); };
  const auto swing_m = [&](const TeleportDef& def) {
    Stage stage(1, {.teleport = def});
    stage.time_s = 0;
    double most_m = 0;
    for (int f = 0; f < 120; ++f) {
      stage.step(stop, kFrame_s);
      most_m = std::max(most_m, shape_m(stage));
    }
    return most_m;
  };
  // 240 m/s^2 in one tick, of which up to 90 are felt.
  const double all_m = swing_m(kNothingIs), bounded_m = swing_m({});
  CHECK(bounded_m < 0.7 * all_m);
  CHECK(bounded_m > 0.1 * all_m);
}

TEST_CASE("rods_keep_what_they_swing_with_when_their_joint_jumps") {
  Stage swinging(1, {}, tailed_pack()), jumping(1, {}, tailed_pack());
  const auto posed = [](int f, float up_m) {
    TailedPose pose = scenes::with_rods(scenes::shake(f * kFrame_s, 2));
    for (Matrix34& joint : pose.joints) joint.m[1][3] += up_m;
    return pose;
  };
  const auto turns = [](const Stage& stage) {
    std::vector<Matrix34> joints(stage.info.joint_count);
    REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
    std::vector<float> out;
    for (const Matrix34& joint : joints)
      for (const auto& row : joint.m) out.insert(out.end(), row, row + 3);
    return out;
  };
  double apart = 0, swing = 0;
  for (int f = 0; f < 150; ++f) {
    REQUIRE(swinging.world.set_pose(swinging.blocks[0], posed(f, 0).pose()).ok());
    REQUIRE(jumping.world.set_pose(jumping.blocks[0], posed(f, f < 100 ? 0 : 0.4f).pose()).ok());
    swinging.world.step(static_cast<float>(kFrame_s));
    jumping.world.step(static_cast<float>(kFrame_s));
    const std::vector<float> own = turns(swinging);
    const TailedPose still = posed(f, 0);
    for (size_t j = 0; j < still.joints.size(); ++j)
      for (int k = 0; k < 9; ++k)
        swing = std::max(swing, std::abs(double{own[9 * j + k]} - double{still.joints[j].m[k / 3][k % 3]}));
    apart = std::max(apart, double{test::largest_distance(own, turns(jumping))});
  }
  CHECK(jumping.report().part_teleports > 0);
  CHECK(swing > 0.1);
  // What the tick of the jump would have changed in the velocity is lost, and forces are found anew.
  CHECK(apart < 0.25 * swing);
}

// Five metres a second, and cuts of the root on the way: none of it is felt, by flesh nor by rods.
TEST_CASE("who_runs_on_over_cuts_and_snap_turns_feels_none_of_them") {
  constexpr double kSpeed_m_s = 5;
  struct Cut {
    const char* name;
    std::function<RootTransform(RootTransform, int)> of;  // of frames since the cut
  };
  const auto turned_by = [](RootTransform root, double angle) {
    root.rotation_xyzw[1] = static_cast<float>(std::sin(angle / 2));
    root.rotation_xyzw[3] = static_cast<float>(std::cos(angle / 2));
    return root;
  };
  const Cut cuts[] = {
      {"a place", [](RootTransform root, int) { return root.position_m[1] += 3, root; }},
      {"two places", [](RootTransform root, int f) { return root.position_m[1] += f == 0 ? 3 : 9, root; }},
      {"a heading", [&](RootTransform root, int) { return turned_by(root, 1.6); }},
      {"two headings", [&](RootTransform root, int f) { return turned_by(root, f == 0 ? 1.6 : 3); }},
      {"to a stand",
       [](RootTransform root, int f) { return root.position_m[0] = 50, root.position_m[1] = f < 0, root; }},
      {"to a stand, twice",
       [](RootTransform root, int f) { return root.position_m[0] = f == 0 ? 50 : 70, root; }},
      {"to twice the speed",
       [](RootTransform root, int f) { return root.position_m[0] += 20 + f * kSpeed_m_s / 60, root; }}};
  for (const Cut& cut : cuts) {
    INFO(cut.name);
    Stage stage(1, {}, tailed_pack());
    std::vector<Matrix34> rest(stage.info.joint_count), joints(stage.info.joint_count);
    double x_m = 0;
    for (int f = -180; f < 60; ++f) {
      const double share = std::clamp((f + 180) / 60.0, 0.0, 1.0);
      x_m += kSpeed_m_s * kFrame_s * share * share * (3 - 2 * share);
      TailedPose pose = scenes::with_rods(scenes::bind_pose());
      pose.root.position_m[0] = x_m;
      if (f >= 0) pose.root = cut.of(pose.root, f);
      REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
      stage.world.step(static_cast<float>(kFrame_s));
      REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
      if (f == -1) rest = joints;
      if (f < 0) continue;
      double moved = 0;
      for (size_t j = 0; j < joints.size(); ++j)
        for (int k = 0; k < 12; ++k)
          moved =
              std::max(moved, std::abs(double{joints[j].m[k / 4][k % 4]} - double{rest[j].m[k / 4][k % 4]}));
      REQUIRE(shape_m(stage) < 0.003);
      // Air blows at a tail from where the body now heads: not at once.
      if (f < 6) REQUIRE(moved < 0.1);
    }
  }
}

// Nine heights a second are gained in a step: taken for a teleport once, and not again as long as it lasts.
TEST_CASE("a_speed_that_begins_at_once_is_a_teleport_once") {
  Stage stage;
  const auto ride = [](double t) {
    BlockPose pose = scenes::bent_pose(0, t < 1 ? 0 : 12 * (t - 1));
    pose.root.position_m[1] = 0.02 * std::sin(15 * t);
    return pose;
  };
  stage.play(ride, 3);
  CHECK(stage.report().teleports == 1);
  CHECK(shape_m(stage) > 0.001);  // and what it does on the way is felt
}

TEST_CASE("reset_forgets_what_was_carried") {
  const auto ended = [](bool cut) {
    Stage stage(1, {}, tailed_pack());
    const auto pose_of = [](double t) { return scenes::with_rods(scenes::shake(t, 2)); };
    for (int f = 0; f < 60; ++f) {
      TailedPose pose = pose_of(f * kFrame_s);
      if (cut && f == 59)
        for (Matrix34& joint : pose.joints) joint.m[1][3] += 1;
      REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
      stage.world.step(f == 59 ? 0 : static_cast<float>(kFrame_s));
    }
    REQUIRE(stage.world.reset(stage.blocks[0]).ok());
    for (int f = 0; f < 5; ++f) {
      REQUIRE(stage.world.set_pose(stage.blocks[0], pose_of(1).pose()).ok());
      stage.world.step(static_cast<float>(kFrame_s));
    }
    std::vector<Matrix34> joints(stage.info.joint_count);
    REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
    return joints;
  };
  const std::vector<Matrix34> plain = ended(false), cut = ended(true);
  for (size_t j = 0; j < plain.size(); ++j)
    for (int k = 0; k < 12; ++k)
      CHECK(plain[j].m[k / 4][k % 4] == Approx(cut[j].m[k / 4][k % 4]).margin(1e-5));
}

TEST_CASE("a_teleport_that_no_tick_has_seen_yet_is_saved_and_restored") {
  const auto played = [](Stage& stage) {
    std::vector<uint64_t> hashes;
    for (int f = 0; f < 30; ++f) {
      stage.pose(stage.blocks[0], scenes::bent_pose(1.2, 0, 0.3));
      stage.world.step(1.0f / 240);
      hashes.push_back(test::hash_of(stage));
    }
    return hashes;
  };
  Stage stage;
  stage.play(scenes::walk, 1, 240);
  uint32_t ticks = 1;
  while (ticks != 0) {  // to a step in which no tick is
    stage.pose(stage.blocks[0], scenes::walk(1));
    ticks = stage.world.step(1.0f / 240).ticks;
  }
  stage.pose(stage.blocks[0], scenes::bent_pose(1.2, 0, 0.3));
  REQUIRE(stage.world.step(1.0f / 240).ticks == 0);
  const std::vector<std::byte> saved = stage.save();
  const std::vector<uint64_t> first = played(stage);
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  CHECK(played(stage) == first);
}

// Asleep in between: nothing of the first is left to take the second for.
TEST_CASE("the_same_jump_a_second_time_is_a_teleport_too") {
  Stage stage;
  stage.play([](double) { return raised(0); }, 1);
  for (int jump = 1; jump <= 3; ++jump) {
    double most_m = 0;
    for (int frame = 0; frame < 6; ++frame) {
      stage.step([&](double) { return raised(20.0 * jump); }, kFrame_s);
      most_m = std::max(most_m, shape_m(stage));
    }
    CHECK(stage.report().teleports == static_cast<uint32_t>(jump));
    CHECK(most_m < kCarried_m);
  }
}

// test_rods.cpp  Bones that are rods: from rest, in motion, over cuts, tiers, sleep and snapshots.
#include <Eigen/Core>
#include <cstring>
#include <limits>
#include <numbers>

#include "tests/scenes/half_spaces.hpp"
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::kTail;
using scenes::TailedPose;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
// Metres, of places half a metre from the root in floats, turned by quaternions in floats a few bones deep.
constexpr double kRounding_m = 3e-6;

using Joints = std::vector<Matrix34>;

const scenes::PackBytes& tailed_pack(const scenes::RodMatter& matter = {}) {
  static std::vector<std::pair<scenes::RodMatter, scenes::PackBytes>> packs;
  for (const auto& [known, pack] : packs)
    if (known.gravity == matter.gravity && known.sag == matter.sag &&
        known.young_modulus_pa == matter.young_modulus_pa &&
        known.max_displacement == matter.max_displacement)
      return pack;
  packs.reserve(16);  // references stay good
  packs.emplace_back(matter, scenes::soft_block({.network = false, .rods = matter}));
  return packs.back().second;
}

struct RodStage : Stage {
  explicit RodStage(const scenes::RodMatter& matter = {}, WorldDef def = {}, uint32_t count = 1)
      : Stage(count, def, tailed_pack(matter)) {}

  FrameReport step_pose(const TailedPose& pose, double dt_s = kFrame_s, size_t index = 0) {
    REQUIRE(world.set_pose(blocks[index], pose.pose()).ok());
    return world.step(static_cast<float>(dt_s));
  }
  void hold(const TailedPose& pose, double seconds) {
    for (int f = 0; f < std::lround(seconds * 60); ++f) step_pose(pose);
  }
  FrameReport step_motion(const test::Motion& motion, double dt_s) {
    time_s += dt_s;
    return step_pose(scenes::with_rods(motion(time_s)), dt_s);
  }
  Joints joints(size_t index = 0) const {
    Joints out(info.joint_count);
    REQUIRE(world.read_joint_matrices(blocks[index], out).ok());
    return out;
  }
};

Eigen::Vector3d place(const Matrix34& joint) {
  return Eigen::Vector3f(joint.m[0][3], joint.m[1][3], joint.m[2][3]).cast<double>();
}

double largest_difference(std::span<const Matrix34> a, std::span<const Matrix34> b) {
  double largest = 0;
  for (size_t j = 0; j < a.size(); ++j)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        largest = std::max(largest,
                           std::abs(static_cast<double>(a[j].m[r][c]) - static_cast<double>(b[j].m[r][c])));
  return largest;
}

bool same_bits(const Joints& a, const Joints& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

TailedPose standing(double wag_rad = 0) { return scenes::with_rods(scenes::bind_pose(), wag_rad); }

}  // namespace

TEST_CASE("reading_joints_refuses_what_does_not_fit_and_writes_nothing") {
  RodStage stage;
  Joints out(stage.info.joint_count - 1, Matrix34{{{7}}});
  CHECK(stage.world.read_joint_matrices(stage.blocks[0], out).code == StatusCode::kInvalidArgument);
  CHECK(out[0].m[0][0] == 7);
  CHECK(stage.world.read_joint_matrices(stage.blocks[0], {}).code == StatusCode::kInvalidArgument);
  CHECK(stage.world.read_joint_matrices({}, out).code == StatusCode::kStaleId);
  CHECK(stage.faults.faults == 1);
  World null;
  CHECK(null.read_joint_matrices(stage.blocks[0], out).code == StatusCode::kInvalidArgument);
  CHECK(stage.info.rod_count == 3);
  CHECK(!stage.world.joint_is_on_rod(stage.asset, 1));
  CHECK(stage.world.joint_is_on_rod(stage.asset, kTail));
  CHECK(!stage.world.joint_is_on_rod(stage.asset, 99));
}

TEST_CASE("a_character_without_rods_gives_back_its_pose") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  std::vector<Matrix34> out(stage.info.joint_count);
  REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], out).ok());
  const scenes::BlockPose pose = scenes::walk(stage.time_s);
  CHECK(std::memcmp(out.data(), pose.joints.data(), sizeof pose.joints) == 0);
  CHECK(stage.info.rod_count == 0);
  CHECK(!stage.world.joint_is_on_rod(stage.asset, 1));
}

TEST_CASE("unmoved_rods_stay_in_the_pose_without_gravity_and_with_it") {
  for (const double gravity : {0.0, 1.0}) {
    for (const double wag_rad : {0.0, 0.4}) {  // the pose need not be the bind pose
      RodStage stage({.gravity = gravity}, {.sleep_tolerance = 0});
      const TailedPose pose = standing(wag_rad);
      stage.hold(pose, 5);
      CHECK(largest_difference(stage.joints(), pose.joints) < kRounding_m);
    }
  }
}

TEST_CASE("sag_lets_gravity_bend_the_posed_shape_by_theory") {
  constexpr double kYoung_pa = 1e8, kRadius_m = 0.02, kDensity = 1000, kGravity = 9.80665;
  RodStage stage({.sag = 1, .young_modulus_pa = kYoung_pa});
  stage.hold(standing(), 5);
  const Joints joints = stage.joints();
  // Joint i bends by l M_i / (E I) under the moment of all that lies beyond it, q (L - x_i)^2 / 2.
  const double area = std::numbers::pi * kRadius_m * kRadius_m,
               stiffness = kYoung_pa * area * kRadius_m * kRadius_m / 4;
  double expected_m = 0;
  for (int i = 0; i < 3; ++i) {
    const double beyond_m = (4 - i) * scenes::kBone_m,
                 moment = kDensity * area * kGravity * beyond_m * beyond_m / 2;
    expected_m += moment * scenes::kBone_m / stiffness * (3 - i) * scenes::kBone_m;
  }
  const double sunk_m = place(standing().joints[kTail + 3]).y() - place(joints[kTail + 3]).y();
  CHECK(expected_m > 0.003);
  CHECK(sunk_m ==
        Approx(expected_m).epsilon(0.01));  // small angles, and what the damping leaves of the swing
  for (int r = 0; r < 3; ++r) CHECK(joints[1].m[r][3] == standing().joints[1].m[r][3]);
}

TEST_CASE("turned_against_gravity_a_rod_sags_and_turned_back_it_returns") {
  RodStage stage;
  TailedPose tilted = standing();  // on its side
  tilted.root.rotation_xyzw[2] = tilted.root.rotation_xyzw[3] = std::sqrt(0.5f);
  stage.hold(tilted, 10);
  CHECK(largest_difference(stage.joints(), tilted.joints) > 0.01);
  stage.hold(standing(), 20);
  CHECK(largest_difference(stage.joints(), standing().joints) < 1e-3);  // what sleep leaves of the swing
}

// The tail's tip from its place, over the tail's length: an angle of 0.3 rad moves it by no more than that.
TEST_CASE("a_rod_is_never_shown_further_from_its_pose_than_its_limit") {
  constexpr double kLimit = 0.3;
  double most[2] = {};
  for (const bool limited : {false, true}) {
    RodStage stage({.young_modulus_pa = 1e5, .max_displacement = limited ? kLimit : 0});
    for (int f = 0; f < 240; ++f) {
      const auto shaken = [](double t) { return scenes::shake(t, 4); };
      stage.step_motion(shaken, kFrame_s);
      const TailedPose pose = scenes::with_rods(shaken(stage.time_s));
      const Eigen::Vector3d off = place(stage.joints()[kTail + 3]) - place(pose.joints[kTail + 3]);
      most[limited] = std::max(most[limited], off.norm() / (3 * scenes::kBone_m));
    }
  }
  CHECK(most[0] > 1.5 * kLimit);
  CHECK(most[1] > 0.8 * kLimit);
  CHECK(most[1] < kLimit);
}

TEST_CASE("a_moving_root_swings_the_tail_and_it_comes_to_rest") {
  RodStage stage;
  double largest = 0;
  for (int f = 0; f < 120; ++f) {
    stage.step_motion([](double t) { return scenes::shake(t, 2); }, kFrame_s);
    largest = std::max(largest, largest_difference(stage.joints(),
                                                   scenes::with_rods(scenes::shake(stage.time_s, 2)).joints));
  }
  CHECK(largest > 0.02);
  stage.hold(standing(), 20);
  CHECK(largest_difference(stage.joints(), standing().joints) < 1e-3);  // what sleep leaves of the swing
  CHECK(stage.report().rod_recoveries == 0);
}

TEST_CASE("bones_keep_their_length_and_hang_together_at_every_frame_rate") {
  for (const double fps : {15.0, 37.0, 60.0, 240.0}) {
    RodStage stage;
    for (int f = 0; f < 3 * fps; ++f) {
      stage.step_motion([](double t) { return scenes::shake(t, 2); }, 1 / fps);
      const Joints joints = stage.joints();
      const TailedPose pose = scenes::with_rods(scenes::shake(stage.time_s, 2));
      REQUIRE((place(joints[kTail]) - place(pose.joints[kTail])).norm() < kRounding_m);
      for (uint32_t b = 0; b < 3; ++b)
        REQUIRE(std::abs((place(joints[kTail + b + 1]) - place(joints[kTail + b])).norm() - scenes::kBone_m) <
                kRounding_m);
    }
  }
}

TEST_CASE("the_surface_is_skinned_by_the_joints_that_are_read") {
  RodStage stage;
  for (int f = 0; f < 40; ++f) stage.step_motion([](double t) { return scenes::shake(t, 3); }, kFrame_s);
  const std::vector<float> surface = stage.read();
  const Joints joints = stage.joints();
  Joints bind(stage.info.joint_count);
  REQUIRE(stage.world.bind_pose(stage.asset, bind).ok());
  pack::PackView view;
  REQUIRE(pack::open_pack(tailed_pack().bytes(), &view).ok());
  double largest = 0, moved = 0;
  size_t seen = 0;
  for (size_t v = 0; v < stage.info.vertex_count; ++v) {
    const pack::SkinRecord& skin = view.skin[v];
    if (skin.joint[0] < kTail) continue;
    Eigen::Vector3d expected =
        Eigen::Vector3f(view.positions.data() + 3 * v).cast<double>() - place(bind[skin.joint[0]]);
    const Matrix34& m = joints[skin.joint[0]];
    Eigen::Matrix3d turn;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) turn(r, c) = static_cast<double>(m.m[r][c]);
    expected = turn * expected + place(m);
    largest = std::max(largest, (expected - Eigen::Vector3f(surface.data() + 3 * v).cast<double>()).norm());
    moved = std::max(
        moved,
        (place(m) - place(scenes::with_rods(scenes::shake(stage.time_s, 3)).joints[skin.joint[0]])).norm());
    ++seen;
  }
  CHECK(seen == 80);
  CHECK(largest < kRounding_m);
  CHECK(moved > 0.01);
}

TEST_CASE("an_animated_tail_keeps_its_animation") {
  RodStage stage({.young_modulus_pa = 1e9});  // stiff: it swings little about its animation
  double worst = 0;
  for (int f = 0; f < 180; ++f) {
    const TailedPose pose = standing(0.15 * (1 - std::cos(2 * std::numbers::pi * f / 120.0)));
    stage.step_pose(pose);
    worst = std::max(worst, largest_difference(stage.joints(), pose.joints));
  }
  CHECK(worst < 0.01);  // of 1.2 rad at the tip, half a second up and half down
}

TEST_CASE("rods_after_a_restore_have_the_same_bits") {
  RodStage stage({}, {}, 2);
  const auto play = [&](int frames) {
    std::vector<Joints> seen;
    for (int f = 0; f < frames; ++f) {
      stage.step_motion([](double t) { return scenes::shake(t, 2); }, 1.0 / 45);
      seen.push_back(stage.joints());
    }
    return seen;
  };
  play(77);
  const std::vector<std::byte> saved = stage.save();
  const double time_s = stage.time_s;
  const Joints at_save = stage.joints();
  const std::vector<Joints> first = play(60);
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  CHECK(stage.save() == saved);
  CHECK(same_bits(stage.joints(), at_save));
  stage.time_s = time_s;
  const std::vector<Joints> second = play(60);
  for (size_t f = 0; f < first.size(); ++f) REQUIRE(same_bits(first[f], second[f]));
  // Another instance, which stood still meanwhile.
  REQUIRE(stage.world.restore_state(stage.blocks[1], saved).ok());
  std::swap(stage.blocks[0], stage.blocks[1]);
  stage.time_s = time_s;
  const std::vector<Joints> third = play(60);
  for (size_t f = 0; f < first.size(); ++f) REQUIRE(same_bits(first[f], third[f]));
}

TEST_CASE("a_snapshot_with_damaged_rods_is_refused") {
  RodStage stage;
  stage.hold(standing(), 0.2);
  std::vector<std::byte> saved = stage.save();
  const std::vector<std::byte> good = saved;
  saved.back() ^= std::byte{1};  // the last of a batch's numbers
  CHECK(stage.world.restore_state(stage.blocks[0], saved).code == StatusCode::kCorrupt);
  CHECK(stage.save() == good);
}

TEST_CASE("a_teleport_carries_rods_along_as_they_are") {
  RodStage here, there;
  const auto jumped = [](TailedPose pose) {
    // A quarter turn about y and a kilometre away.
    const float* q = pose.root.rotation_xyzw;
    const float c = std::sqrt(0.5f);
    const float turned[4] = {c * q[0] + c * q[2], c * q[1] + c * q[3], c * q[2] - c * q[0],
                             c * q[3] - c * q[1]};
    std::copy_n(turned, 4, pose.root.rotation_xyzw);
    const double x = pose.root.position_m[0], z = pose.root.position_m[2];
    pose.root.position_m[0] = z + 1000;
    pose.root.position_m[1] += 5;
    pose.root.position_m[2] = -x;
    return pose;
  };
  double worst = 0, swing = 0;
  for (int f = 0; f < 240; ++f) {
    const TailedPose pose = scenes::with_rods(scenes::shake(f * kFrame_s, 2));
    here.step_pose(pose);
    there.step_pose(f < 120 ? pose : jumped(pose));
    worst = std::max(worst, largest_difference(here.joints(), there.joints()));
    swing = std::max(swing, largest_difference(here.joints(), pose.joints));
  }
  CHECK(swing > 0.02);
  // What is compared is carried on at the last velocity over the jump's step: of the order of one tick's
  // change of velocity, and it dies down with the swing.
  CHECK(worst < 0.05 * swing);
}

TEST_CASE("rods_do_not_know_how_far_from_the_origin_they_are") {
  RodStage near, far;
  double worst = 0;
  for (int f = 0; f < 120; ++f) {
    TailedPose pose = scenes::with_rods(scenes::shake(f * kFrame_s, 2));
    near.step_pose(pose);
    pose.root.position_m[0] += 1e6;
    pose.root.position_m[2] -= 3e6;
    far.step_pose(pose);
    worst = std::max(worst, largest_difference(near.joints(), far.joints()));
  }
  CHECK(worst < 1e-4);  // a double's spacing at 3e6 m, 5e-10 m, over the square of a tick is 2e-6 m/s^2
}

TEST_CASE("a_pause_holds_rods_against_the_pose") {
  RodStage stage;
  for (int f = 0; f < 30; ++f) stage.step_motion([](double t) { return scenes::shake(t, 2); }, kFrame_s);
  const Joints before = stage.joints();
  const TailedPose pose = scenes::with_rods(scenes::shake(stage.time_s, 2));
  for (int f = 0; f < 10; ++f) stage.step_pose(pose, 0);
  CHECK(same_bits(stage.joints(), before));
}

TEST_CASE("without_simulation_rods_fade_to_the_pose_and_come_back_without_a_jump") {
  RodStage stage, undisturbed;
  const auto motion = [](double t) { return scenes::shake(t, 2); };
  for (int f = 0; f < 60; ++f) stage.step_motion(motion, kFrame_s), undisturbed.step_motion(motion, kFrame_s);
  REQUIRE(stage.world.set_budget_us(0).ok());
  Joints before = stage.joints(), swing = before;
  double largest_change = 0, largest_swing = 0;
  const auto frame = [&] {
    stage.step_motion(motion, kFrame_s);
    undisturbed.step_motion(motion, kFrame_s);
    largest_change = std::max(largest_change, largest_difference(stage.joints(), before));
    largest_swing = std::max(largest_swing, largest_difference(undisturbed.joints(), swing));
    before = stage.joints();
    swing = undisturbed.joints();
  };
  for (int f = 0; f < 32; ++f) frame();
  const TailedPose pose = scenes::with_rods(motion(stage.time_s));
  CHECK(std::memcmp(stage.joints().data(), pose.joints.data(), sizeof pose.joints) == 0);
  REQUIRE(stage.world.set_budget_us(std::numeric_limits<float>::infinity()).ok());
  for (int f = 0; f < 60; ++f) frame();
  CHECK(largest_difference(stage.joints(), scenes::with_rods(motion(stage.time_s)).joints) > 1e-3);
  WARN("largest change of a matrix in a frame: undisturbed " << largest_swing << ", denied and given back "
                                                             << largest_change);
  constexpr double kPop = 2;
  CHECK(largest_change < kPop * largest_swing);  // as tissue's (test_blend.cpp)
}

TEST_CASE("reset_puts_rods_into_the_next_pose") {
  RodStage stage;
  for (int f = 0; f < 30; ++f) stage.step_motion([](double t) { return scenes::shake(t, 2); }, kFrame_s);
  REQUIRE(stage.world.reset(stage.blocks[0]).ok());
  TailedPose pose = standing(0.2);
  pose.root.position_m[1] = 1;
  stage.step_pose(pose);
  CHECK(largest_difference(stage.joints(), pose.joints) < kRounding_m);
}

TEST_CASE("rods_at_rest_sleep_and_wake_with_the_pose") {
  RodStage stage;
  for (int f = 0; f < 60; ++f) stage.step_motion([](double t) { return scenes::shake(t, 1); }, kFrame_s);
  CHECK(stage.report().rods_asleep == 0);
  stage.hold(standing(), 20);
  CHECK(stage.report().rods_asleep == 3);
  const Joints asleep = stage.joints();
  stage.hold(standing(), 1);
  CHECK(same_bits(stage.joints(), asleep));
  TailedPose pushed = standing();
  pushed.root.position_m[0] = 0.01;
  stage.step_pose(pushed);
  CHECK(stage.report().rods_asleep == 0);
  CHECK(largest_difference(stage.joints(), pushed.joints) > 1e-3);
  RodStage awake({}, {.sleep_tolerance = 0});
  awake.hold(standing(), 20);
  CHECK(awake.report().rods_asleep == 0);
}

TEST_CASE("violent_poses_leave_rods_finite_and_together") {
  RodStage stage;
  std::vector<float> random;
  uint32_t seed = 7;
  const auto next = [&] {
    return static_cast<float>((seed = seed * 1664525u + 1013904223u) >> 8) / 8388608.0f - 1;
  };
  for (int f = 0; f < 600; ++f) {
    TailedPose pose = standing(next() * 3.0);
    for (int k = 0; k < 3; ++k) pose.root.position_m[k] = static_cast<double>(next());
    for (float& q : pose.root.rotation_xyzw) q = next();
    stage.step_pose(pose, 0.005 + 0.05 * std::abs(static_cast<double>(next())));
    const Joints joints = stage.joints();
    for (const Matrix34& joint : joints)
      for (const auto& row : joint.m)
        for (const float value : row) REQUIRE(std::isfinite(value));
    for (uint32_t b = 0; b < 3; ++b)
      REQUIRE(std::abs((place(joints[kTail + b + 1]) - place(joints[kTail + b])).norm() - scenes::kBone_m) <
              kRounding_m);
  }
  stage.hold(standing(), 30);
  CHECK(largest_difference(stage.joints(), standing().joints) < 1e-2);
}

TEST_CASE("dropped_time_takes_rods_along") {
  RodStage stage({}, {.max_ticks_per_step = 2});
  TailedPose pose = standing();
  stage.hold(pose, 0.5);
  // A hitch of a second in which the character moves 1.5 m: half of its teleport distance and more.
  pose.root.position_m[0] = 1.5;
  stage.step_pose(pose, 1);
  stage.hold(pose, 1.0 / 60);
  CHECK(largest_difference(stage.joints(), pose.joints) < 0.3);
  CHECK(stage.report().rod_recoveries == 0);
}

TEST_CASE("tissue_has_the_same_bits_with_rods_and_without") {
  RodStage with;
  Stage without(1, {}, test::weightless_pack());
  for (int f = 0; f < 90; ++f) {
    const scenes::BlockPose pose = scenes::walk(f * kFrame_s);
    with.step_pose(scenes::with_rods(pose));
    without.pose(without.blocks[0], pose);
    without.world.step(static_cast<float>(kFrame_s));
  }
  std::vector<float> a = with.read(), b = without.read();
  REQUIRE(a.size() > b.size());
  a.resize(b.size());
  CHECK(a == b);
}

TEST_CASE("rods_cost_a_stage_of_their_own_in_the_report") {
  RodStage stage;
  const FrameReport report = stage.step_motion([](double t) { return scenes::shake(t, 2); }, 3 * kFrame_s);
  CHECK(report.rods_us > 0);
  CHECK(report.rods_us < report.total_us);
}

TEST_CASE("rods_have_the_same_bits_on_any_number_of_workers") {
  scenes::ThreadPool pool(3);
  RodStage serial({}, {}, 4), threaded({}, {.tasks = pool.hook()}, 4);
  for (int f = 0; f < 60; ++f) {
    for (RodStage* stage : {&serial, &threaded}) {
      for (size_t i = 0; i < stage->blocks.size(); ++i) {
        const TailedPose pose =
            scenes::with_rods(scenes::shake(f * kFrame_s + 0.1 * static_cast<double>(i), 2));
        REQUIRE(stage->world.set_pose(stage->blocks[i], pose.pose()).ok());
      }
      stage->world.step(static_cast<float>(kFrame_s));
    }
    for (size_t i = 0; i < 4; ++i) REQUIRE(same_bits(serial.joints(i), threaded.joints(i)));
  }
}

TEST_CASE("a_character_of_rods_alone_swings") {
  const scenes::PackBytes pack =
      scenes::soft_block({.regions = 0, .network = false, .rods = scenes::RodMatter{}});
  Stage stage(1, {}, pack);
  CHECK(stage.info.region_count == 0);
  std::vector<Matrix34> joints(stage.info.joint_count);
  double largest = 0;
  for (int f = 0; f < 60; ++f) {
    const TailedPose pose = scenes::with_rods(scenes::shake(f * kFrame_s, 2));
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
    stage.world.step(static_cast<float>(kFrame_s));
    REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
    largest = std::max(largest, largest_difference(joints, pose.joints));
  }
  CHECK(largest > 0.01);
  CHECK(test::all_finite(stage.read()));
}

TEST_CASE("a_character_of_which_nothing_swings_follows_its_pose") {
  const scenes::PackBytes pack = scenes::soft_block({.regions = 0, .network = false});
  Stage stage(1, {}, pack);
  CHECK(stage.info.region_count == 0);
  std::vector<Matrix34> joints(stage.info.joint_count);
  for (int f = 0; f < 60; ++f) {
    const auto pose = scenes::shake(f * kFrame_s, 2);
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
    stage.world.step(static_cast<float>(kFrame_s));
    REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
    REQUIRE(largest_difference(joints, pose.joints) < 1e-6);
  }
  CHECK(test::all_finite(stage.read()));
}

TEST_CASE("rods_lie_on_what_a_source_knows_wherever_the_character_stands_and_wake_for_what_comes") {
  for (const double away_m : {0.0, 1e6}) {
    // The tail sticks out backwards at the waist, 0.3 m up, and sags under the floor without one.
    scenes::HalfSpaces floor;
    RodStage stage({.sag = 1}, {}, 0);
    InstanceId made;
    REQUIRE(stage.world.create_instance({.asset = stage.asset, .contacts = {.source = &floor}}, &made).ok());
    stage.blocks.push_back(made);
    TailedPose pose = standing();
    pose.root.position_m[0] = away_m;
    stage.hold(pose, 20);
    const double hanging_m = place(stage.joints()[kTail + 3]).y();
    CHECK(stage.report().rods_asleep > 0);
    // It comes up under the sleeping tail and stays.
    const double top_m = hanging_m + 0.05;
    for (int f = 0; f <= 60; ++f) {
      floor.walls = {{{0, top_m - 0.1 * (1 - f / 60.0), 0}, {0, 1, 0}, {0, f < 60 ? 0.1f : 0, 0}}};
      stage.step_pose(pose);
    }
    stage.hold(pose, 2);
    CHECK(stage.report().rods_asleep == 0);
    CHECK(stage.report().rod_contacts > 0);
    CHECK(stage.report().contacts_dropped == 0);
    const Joints joints = stage.joints();
    for (uint32_t bone = kTail; bone < kTail + 4; ++bone) CHECK(place(joints[bone]).y() > top_m);
    // Its bits go on after a restore.
    const std::vector<std::byte> saved = stage.save();
    stage.hold(pose, 0.5);
    const Joints after = stage.joints();
    REQUIRE(stage.world.restore_state(made, saved).ok());
    stage.hold(pose, 0.5);
    CHECK(same_bits(after, stage.joints()));
  }
}

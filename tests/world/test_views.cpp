// test_views.cpp  What no view shows is left alone, and comes back without a jump.
#include <cmath>
#include <limits>
#include <utility>

#include "tests/world/stage.hpp"
#include "world/step/look.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Of the block at the origin, from `away_m` in front of it, looking at it or away from it.
View look_from(double away_m, bool towards = true) {
  View view{.position_m = {0, 0.3, towards ? away_m : -away_m}};
  return view;
}

void see(Stage& stage, bool seen) {
  const View view = look_from(4, seen);
  REQUIRE(stage.world.set_views({&view, 1}).ok());
}

// A wall that is there or not; counts how often it is asked.
struct Wall final : OcclusionSource {
  bool there = false;
  uint32_t rays = 0;
  bool is_blocked(const double (&)[3], const double (&)[3]) noexcept override {
    ++rays;
    return there;
  }
};

}  // namespace

TEST_CASE("what_is_no_view_is_refused_and_the_views_stay") {
  Stage stage(2);
  see(stage, false);
  std::vector<View> many(kMostViews + 1);
  CHECK(stage.world.set_views(many).code == StatusCode::kInvalidArgument);
  std::vector<View> bad(4);
  bad[0].position_m[0] = std::nan("");
  bad[1].aspect = kNan;
  bad[2].height_rad = -1;
  bad[3].far_m = kNan;
  for (const View& view : bad) {
    const View pair[] = {look_from(4), view};
    CHECK_FALSE(stage.world.set_views(pair).ok());
  }
  CHECK(World().set_views({}).code == StatusCode::kInvalidArgument);
  CHECK(stage.world.set_hidden({}, true).code == StatusCode::kStaleId);
  CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == 2);
}

TEST_CASE("without_views_all_are_seen_and_hidden_by_the_caller_they_are_not") {
  Stage stage(3);
  CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == 0);
  REQUIRE(stage.world.set_hidden(stage.blocks[1], true).ok());
  const FrameReport report = stage.step(scenes::walk, 1.0 / 60);
  CHECK(report.instances_hidden == 1);
  CHECK(report.instances_network == 2);
  CHECK(stage.report(1).hidden);
  CHECK(stage.report(1).cost_us == 0);
  CHECK_FALSE(stage.report(0).hidden);
  REQUIRE(stage.world.set_hidden(stage.blocks[1], false).ok());
  CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == 0);
}

TEST_CASE("one_view_of_several_is_enough_and_no_view_shows_what_it_showed") {
  Stage stage(1);
  stage.play(scenes::walk, 0.5);
  const View views[] = {look_from(4, false), look_from(6)};
  REQUIRE(stage.world.set_views(views).ok());
  CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == 0);
  REQUIRE(stage.world.set_views({views, 1}).ok());
  const std::vector<float> shown = stage.read();
  stage.play(scenes::walk, 0.5);
  CHECK(stage.report().hidden);
  CHECK(stage.read() == shown);
}

TEST_CASE("a_camera_inside_a_character_sees_it") {
  Stage stage(1);
  View inside = look_from(0);
  for (const float fov_rad : {0.01f, 1.0f, 3.0f}) {
    inside.height_rad = fov_rad;
    REQUIRE(stage.world.set_views({&inside, 1}).ok());
    CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == 0);
  }
}

// Of two that the eye is inside of, the caller's importance decides: it is as large as the view, and no
// larger. What is in front of it waits.
TEST_CASE("a_camera_inside_characters_gets_them_served_as_large_as_the_view") {
  Stage stage(0, {.sleep_tolerance = 0, .budget_mode = BudgetMode::kWorkUnits});
  for (const auto& [z_m, importance] : {std::pair{-6.0, 2.0f}, {0.0, 1.0f}, {0.0, 2.0f}}) {
    InstanceId made;
    REQUIRE(
        stage.world
            .create_instance(
                {.asset = stage.asset, .importance = importance, .root = {.position_m = {0, 0, z_m}}}, &made)
            .ok());
    stage.blocks.push_back(made);
  }
  View inside = look_from(0);
  inside.position_m[1] = static_cast<double>(0.15f);  // the very middle, half way between the joints
  REQUIRE(stage.world.set_views({&inside, 1}).ok());
  REQUIRE(stage.world.set_budget_us(1.1f * test::tier_cost_us(Tier::kModal)).ok());
  for (int f = 0; f < 30; ++f) {
    const FrameReport report = stage.world.step(1.0f / 60);
    CHECK(report.instances_hidden == 0);
    CHECK((report.expected_error > 0 && report.expected_error < 1));
  }
  CHECK(stage.report(2).tier == Tier::kModal);
  for (const size_t i : {0u, 1u}) CHECK(stage.report(i).tier != Tier::kModal);
  REQUIRE(stage.world.set_budget_us(3.3f * test::tier_cost_us(Tier::kNetwork)).ok());
  CHECK(stage.world.step(1.0f / 60).instances_network == 3);
}

// They stand, and would sleep at no cost.
TEST_CASE("who_is_nearer_to_the_eye_gets_what_the_budget_pays_for") {
  Stage stage(0, {.sleep_tolerance = 0, .budget_mode = BudgetMode::kWorkUnits});
  for (const double z : {-30.0, 0.0}) {
    InstanceId made;
    REQUIRE(
        stage.world.create_instance({.asset = stage.asset, .root = {.position_m = {0, 0, z}}}, &made).ok());
    stage.blocks.push_back(made);
  }
  see(stage, true);
  REQUIRE(stage.world.set_budget_us(1.1f * test::tier_cost_us(Tier::kModal)).ok());
  for (int f = 0; f < 30; ++f) stage.world.step(1.0f / 60);
  CHECK(stage.report(1).tier == Tier::kModal);
  CHECK(stage.report(0).tier != Tier::kModal);
}

// Against one that was seen all the while: a second later within a tenth of how far the flesh swings, and in
// no frame half as far again as that one moves in a frame.
TEST_CASE("who_comes_back_is_soon_where_it_would_have_been_and_does_not_jump") {
  for (const double away_s : {0.1, 0.4, 3.0}) {
    Stage stage(1), seen(1);
    const auto both = [&](double seconds) {
      stage.play(scenes::walk, seconds), seen.play(scenes::walk, seconds);
    };
    both(2);
    REQUIRE(stage.world.set_hidden(stage.blocks[0], true).ok());
    both(away_s);
    REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
    std::vector<float> last, last_seen;
    double largest_step = 0, seen_step = 0, swing = 0;
    for (int f = 0; f < 60; ++f) {
      both(1.0 / 60);
      const std::vector<float> now = stage.read(0, Space::kBind), now_seen = seen.read(0, Space::kBind);
      if (f > 0) largest_step = std::max(largest_step, test::largest_distance(now, last));
      if (f > 0) seen_step = std::max(seen_step, test::largest_distance(now_seen, last_seen));
      last = now, last_seen = now_seen;
      swing = std::max(swing, test::largest_length(now_seen));
    }
    const double apart = test::largest_distance(last, last_seen);
    INFO("away " << away_s << " s: swing " << swing << " m, apart " << apart << " m, step " << largest_step
                 << " m");
    CHECK(apart < 0.1 * swing);
    CHECK(largest_step < 1.5 * seen_step);
  }
}

// Less than a teleport, and more; a longer frame would carry a speed on that was none.
TEST_CASE("where_it_went_unseen_is_not_felt") {
  const double far_m = GENERATE(1.5, 100.0);
  Stage stage(1);
  const auto at = [](double x_m) {
    scenes::BlockPose pose = scenes::bind_pose();
    pose.root.position_m[0] = x_m;
    return pose;
  };
  stage.play([&](double) { return at(0); }, 0.5);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], true).ok());
  stage.play([&](double t) { return at(far_m * t); }, 1);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
  for (int f = 0; f < 30; ++f) {
    stage.step([&](double) { return at(far_m); }, f == 1 ? 1.0 / 30 : 1.0 / 60);
    CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-5);
  }
}

// Carried on, it swings: at 3.5 Hz through zero after four ticks.
TEST_CASE("what_was_away_for_long_comes_back_without_displacement_and_what_was_not_carries_it_on") {
  for (const double away_s : {0.017, 1.0}) {
    Stage stage(1);
    stage.play(scenes::walk, 2);
    const double before = test::largest_length(stage.read(0, Space::kBind));
    REQUIRE(before > 1e-3);
    REQUIRE(stage.world.set_hidden(stage.blocks[0], true).ok());
    stage.play(scenes::walk, away_s);
    REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
    stage.step(scenes::walk, 1.0 / 60);
    const double after = test::largest_length(stage.read(0, Space::kBind));
    CHECK((away_s > 0.5 ? after == 0 : after > 0.5 * before));
  }
}

TEST_CASE("a_restored_pose_is_looked_for_where_it_is") {
  Stage stage(1);
  see(stage, true);
  stage.step([](double) { return scenes::bind_pose(); }, 1.0 / 60);
  const std::vector<std::byte> saved = stage.save();
  scenes::BlockPose away = scenes::bind_pose();
  for (Matrix34& joint : away.joints) joint.m[0][3] += 500;
  stage.step([&](double) { return away; }, 1.0 / 60);
  REQUIRE(stage.report().hidden);
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  stage.world.step(1.0f / 60);
  CHECK_FALSE(stage.report().hidden);
}

TEST_CASE("what_something_hides_is_hidden_after_the_stated_looks_and_seen_with_the_first_ray") {
  Wall wall;
  constexpr uint32_t kCount = 5;
  Stage stage(kCount, {.occlusion = &wall, .sight_rays_per_step = 2 * world::kRaysALook});
  see(stage, true);
  constexpr uint32_t kRound = (kCount + 1) / 2;  // steps until all were looked at
  CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == 0);
  wall.there = true;
  wall.rays = 0;
  for (uint32_t f = 0; f < kRound * world::kBlindLooks; ++f) stage.step(scenes::walk, 1.0 / 60);
  CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == kCount);
  CHECK(wall.rays <= (kRound * world::kBlindLooks + 1) * 2 * world::kRaysALook);
  wall.there = false;
  for (uint32_t f = 0; f < kRound; ++f) stage.step(scenes::walk, 1.0 / 60);
  CHECK(stage.step(scenes::walk, 1.0 / 60).instances_hidden == 0);
}

// One of five a step, and a wall that comes and goes: who is hidden when depends on whose turn it is.
TEST_CASE("looks_go_on_after_a_rollback_where_they_were") {
  Wall wall;
  Stage stage(5, {.occlusion = &wall, .sight_rays_per_step = world::kRaysALook});
  see(stage, true);
  const auto hidden = [&](int first, int frames) {
    std::vector<bool> all;
    for (int f = first; f < first + frames; ++f) {
      wall.there = f % 27 < 20;
      stage.step(scenes::walk, 1.0 / 60);
      for (size_t i = 0; i < 5; ++i) all.push_back(stage.report(i).hidden);
    }
    return all;
  };
  hidden(0, 13);
  std::vector<std::vector<std::byte>> saved;
  for (size_t i = 0; i < 5; ++i) saved.push_back(stage.save(i));
  const double time_s = stage.time_s;
  const std::vector<bool> first = hidden(13, 51);
  CHECK(std::ranges::count(first, true) > 0);
  for (size_t i = 0; i < 5; ++i) REQUIRE(stage.world.restore_state(stage.blocks[i], saved[i]).ok());
  stage.time_s = time_s;
  CHECK(hidden(13, 51) == first);
}

TEST_CASE("without_rays_or_without_views_nothing_is_asked") {
  Wall wall;
  wall.there = true;
  Stage few(3, {.occlusion = &wall, .sight_rays_per_step = world::kRaysALook - 1}),
      none(3, {.occlusion = &wall});
  see(few, true);
  few.play(scenes::walk, 0.5);
  none.play(scenes::walk, 0.5);
  CHECK(wall.rays == 0);
  CHECK(few.step(scenes::walk, 1.0 / 60).instances_hidden == 0);
}

TEST_CASE("a_hidden_block_goes_on_with_the_same_bits_after_a_restore") {
  Stage stage(1);
  stage.play(scenes::walk, 1);
  see(stage, false);
  stage.play(scenes::walk, 0.2);
  const std::vector<std::byte> saved = stage.save();
  const std::vector<float> shown = stage.read();
  const double time_s = stage.time_s;
  const auto go_on = [&] {
    stage.time_s = time_s;
    see(stage, false);
    stage.play(scenes::walk, 0.1);
    see(stage, true);
    stage.play(scenes::walk, 0.5);
    return stage.save();
  };
  const std::vector<std::byte> first = go_on();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  CHECK(stage.read() == shown);
  CHECK(go_on() == first);
}

TEST_CASE("how_long_a_block_was_hidden_is_kept_whatever_it_is_told_meanwhile") {
  const auto shown_after = [](bool told) {
    Stage stage(1);
    stage.play(scenes::walk, 1);
    see(stage, false);
    stage.play(scenes::walk, 0.07);
    if (told) {
      REQUIRE(stage.world.set_importance(stage.blocks[0], 1).ok());
      REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
      REQUIRE_FALSE(stage.world.restore_state(stage.blocks[0], {}).ok());
    }
    stage.play(scenes::walk, 0.05);
    see(stage, true);
    stage.play(scenes::walk, 0.1);
    return stage.save();
  };
  CHECK(shown_after(true) == shown_after(false));
}

TEST_CASE("what_was_hidden_by_something_is_seen_once_there_are_no_views") {
  Wall wall;
  wall.there = true;
  Stage stage(1, {.occlusion = &wall});
  see(stage, true);
  stage.play(scenes::walk, 0.2);
  REQUIRE(stage.report().why == TierReason::kHidden);
  CHECK(stage.report().error == 1);
  REQUIRE(stage.world.set_views({}).ok());
  stage.step(scenes::walk, 1.0 / 60);
  CHECK(stage.report().why != TierReason::kHidden);
}

// A pose that travels in the character's space, restored when no pose is waiting.
TEST_CASE("a_restored_pose_that_has_travelled_is_looked_for_where_it_is") {
  Stage stage(1);
  scenes::BlockPose away = scenes::bind_pose();
  for (Matrix34& joint : away.joints) joint.m[0][3] += 500;
  stage.step([](double) { return scenes::bind_pose(); }, 1.0 / 60);
  stage.step([&](double) { return away; }, 1.0 / 60);
  const std::vector<std::byte> saved = stage.save();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  see(stage, true);
  stage.world.step(1.0f / 60);
  CHECK(stage.report().why == TierReason::kHidden);
}

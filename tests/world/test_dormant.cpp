// test_dormant.cpp  What sleeps under a pose that does not change is not stepped, and nobody can tell.
#include "character/rest/dormant.hpp"
#include "character/rest/sleep.hpp"
#include "character/tick.hpp"
#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kTolerance = 2e-4f;

WorldDef in_work_units() { return {.sleep_tolerance = kTolerance, .budget_mode = BudgetMode::kWorkUnits}; }

// Walks for two seconds, then stands for good.
scenes::BlockPose walk_and_stand(double time_s) { return scenes::walk(std::min(time_s, 2.0)); }

FrameReport stand(Stage& stage) { return stage.step(walk_and_stand, kFrame_s); }

// Until all are dormant.
void put_to_rest(Stage& stage) {
  stage.play(walk_and_stand, 12);
  REQUIRE(stand(stage).instances_dormant == stage.blocks.size());
}

scenes::BlockPose moved(double by_m) {
  scenes::BlockPose pose = walk_and_stand(2);
  pose.root.position_m[0] += by_m;
  return pose;
}

}  // namespace

TEST_CASE("what_sleeps_under_an_unchanged_pose_is_not_stepped") {
  Stage stage(2, {.sleep_tolerance = kTolerance});
  put_to_rest(stage);
  const std::vector<float> before = stage.read();
  const FrameReport report = stand(stage);
  CHECK(report.instances_network == 2);
  CHECK(report.regions_asleep == 4);
  CHECK(report.tissue_us + report.drive_us + report.publish_us == 0);
  CHECK(stage.report().cost_us == 0);
  CHECK(stage.report().why == TierReason::kStill);
  CHECK(stage.report().dormant);
  CHECK(stage.read() == before);
}

TEST_CASE("a_pose_that_is_not_set_again_is_an_unchanged_one") {
  Stage stage(1, in_work_units());
  stage.play(walk_and_stand, 2.5);
  for (int f = 0; f < 600; ++f) stage.world.step(static_cast<float>(kFrame_s));
  CHECK(stage.report().dormant);
}

TEST_CASE("without_a_sleep_tolerance_nothing_is_dormant") {
  Stage stage(1, {.sleep_tolerance = 0});
  stage.play([](double) { return scenes::bind_pose(); }, 3);
  CHECK_FALSE(stage.report().dormant);
}

// The smallest change there is.
TEST_CASE("any_other_pose_wakes_it_in_that_step") {
  Stage stage(1, in_work_units());
  put_to_rest(stage);
  scenes::BlockPose pose = walk_and_stand(2);
  float& place = pose.joints.back().m[0][3];
  place = std::nextafter(place, 10.0f);
  stage.pose(stage.blocks[0], pose);
  CHECK(stage.world.step(static_cast<float>(kFrame_s)).instances_dormant == 0);
}

// Half a micrometre wakes no region, and in the step after it the pose is on its way.
TEST_CASE("one_long_step_under_an_unchanged_pose_is_no_stillness") {
  WorldDef def = in_work_units();
  def.max_ticks_per_step = 8;
  Stage stage(1, def);
  put_to_rest(stage);
  const auto long_step = [&] {
    stage.pose(stage.blocks[0], moved(5e-7));
    stage.world.step(8 / 60.0f);
    return stage.report();
  };
  CHECK_FALSE(long_step().dormant);
  const InstanceReport second = long_step();
  CHECK(second.regions_asleep == 2);
  CHECK_FALSE(second.dormant);
  CHECK(long_step().dormant);
}

TEST_CASE("a_pose_that_was_set_and_taken_back_before_a_step_changes_nothing_shown") {
  Stage stage(1, in_work_units());
  put_to_rest(stage);
  const std::vector<float> before = stage.read();
  stage.pose(stage.blocks[0], moved(0.3));
  CHECK(stand(stage).instances_dormant == 0);
  CHECK(stage.read() == before);
  CHECK(stand(stage).instances_dormant == 1);
}

// Beside one that never sleeps: the same bound as of sleep itself (test_sleep.cpp).
TEST_CASE("what_wakes_moves_as_if_it_had_been_stepped_all_the_while") {
  pack::PackView view;
  REQUIRE(pack::open_pack(test::block_pack().bytes(), &view).ok());
  const double bound_m = 6 * static_cast<double>(kTolerance * view.regions[0].radius_m);
  const auto again = [](double time_s) {
    return scenes::walk(time_s < 12 ? std::min(time_s, 2.0) : time_s - 10);
  };
  for (const double frame_s : {1.0 / 60, 1.0 / 144, 1.0 / 25}) {
    Stage sleeper(1, in_work_units()),
        waker(1, {.sleep_tolerance = 0, .budget_mode = BudgetMode::kWorkUnits});
    uint32_t dormant = 0;
    double worst_m = 0;
    for (double t = 0; t < 15; t += frame_s) {
      dormant += sleeper.step(again, frame_s).instances_dormant;
      waker.step(again, frame_s);
      worst_m = std::max(worst_m, test::largest_distance(sleeper.read(), waker.read()));
    }
    CAPTURE(frame_s, dormant, worst_m);
    CHECK(dormant > 1 / frame_s);
    CHECK(worst_m <= bound_m);
  }
}

TEST_CASE("no_budget_being_hidden_and_a_reset_end_it") {
  Stage stage(3, in_work_units());
  put_to_rest(stage);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], true).ok());
  REQUIRE(stage.world.reset(stage.blocks[1]).ok());
  const FrameReport report = stand(stage);
  CHECK(report.instances_dormant == 1);
  CHECK(report.instances_hidden == 1);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
  CHECK(stand(stage).instances_dormant == 1);
  REQUIRE(stage.world.set_budget_us(0).ok());
  CHECK(stand(stage).instances_dormant == 0);
  CHECK(stand(stage).instances_skinned == 3);
}

TEST_CASE("it_takes_nothing_of_the_budget") {
  Stage stage(2, in_work_units());
  put_to_rest(stage);
  REQUIRE(stage.world.set_budget_us(1.1f * test::tier_cost_us(Tier::kNetwork)).ok());
  double walked_s = 0;
  for (int f = 0; f < 30; ++f) {
    stage.pose(stage.blocks[0], scenes::walk(walked_s += kFrame_s));
    stage.world.step(static_cast<float>(kFrame_s));
  }
  CHECK(stage.report(0).tier == Tier::kNetwork);
  CHECK(stage.report(1).tier == Tier::kNetwork);
  CHECK(stage.report(1).dormant);
}

TEST_CASE("what_fell_asleep_below_its_best_sleeps_on_in_the_tier_that_it_has") {
  Stage stage(3, in_work_units());
  REQUIRE(stage.world.set_budget_us(0.95f * test::tier_cost_us(Tier::kNetwork)).ok());
  stage.play(walk_and_stand, 30);
  const FrameReport poor = stand(stage);
  REQUIRE(poor.instances_dormant == 3);
  REQUIRE(poor.instances_modal == 3);
  const std::vector<float> before = stage.read();
  REQUIRE(stage.world.set_budget_us(std::numeric_limits<float>::infinity()).ok());
  CHECK(stand(stage).instances_modal == 3);
  CHECK(stage.read() == before);
  for (const InstanceId block : stage.blocks) stage.pose(block, moved(0.3));
  CHECK(stage.world.step(static_cast<float>(kFrame_s)).instances_network == 3);
}

TEST_CASE("before_its_first_pose_nothing_is_dormant") {
  Stage stage(1, in_work_units());
  for (int f = 0; f < 300; ++f) stage.world.step(static_cast<float>(kFrame_s));
  CHECK(stage.report().regions_asleep == 2);
  CHECK_FALSE(stage.report().dormant);
}

// Wherever in a tick the frame ends: what is restored is published anew.
TEST_CASE("what_is_restored_is_shown_as_it_was") {
  Stage stage(1, in_work_units());
  for (int f = 0; f < 1500; ++f) {
    stage.step(walk_and_stand, 1.0 / 144);
    const std::vector<float> before = stage.read();
    REQUIRE(stage.world.restore_state(stage.blocks[0], stage.save()).ok());
    if (stage.report().dormant) CHECK(stage.read() == before);
  }
  CHECK(stage.report().dormant);
}

TEST_CASE("it_is_part_of_the_snapshot") {
  Stage stage(1, in_work_units());
  put_to_rest(stage);
  const std::vector<std::byte> saved = stage.save();
  const auto walk_on = [&] {
    std::vector<uint64_t> hashes;
    for (int f = 0; f < 60; ++f) {
      stage.pose(stage.blocks[0], f < 20 ? walk_and_stand(2) : scenes::walk(f * kFrame_s));
      stage.world.step(static_cast<float>(kFrame_s));
      hashes.push_back(test::hash_of(stage.read()));
    }
    return hashes;
  };
  const std::vector<uint64_t> first = walk_on();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  CHECK(stage.report().dormant);
  CHECK(walk_on() == first);
}

// Its corrections vanish with the swing of its base: e^(-0.1 2 pi 3.5 t) is 1e-6 after 6.3 s.
TEST_CASE("a_network_comes_to_rest_with_its_base_under_a_pose_that_stays") {
  Stage stage(1, in_work_units());
  stage.play(walk_and_stand, 2 + 6.5);
  CHECK(stage.report().tier == Tier::kNetwork);
  CHECK(stage.report().regions_asleep == 2);
  CHECK(stage.report().dormant);
}

TEST_CASE("what_may_touch_something_is_never_dormant") {
  scenes::HalfSpaces nothing;
  Stage stage(0, in_work_units());
  InstanceId made;
  REQUIRE(stage.world.create_instance({.asset = stage.asset, .contacts = {.source = &nothing}}, &made).ok());
  stage.blocks.push_back(made);
  stage.play(walk_and_stand, 12);
  CHECK(stage.report().regions_asleep == 2);
  CHECK_FALSE(stage.report().dormant);
}

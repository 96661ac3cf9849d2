// test_skip_pose.cpp  Poses of a lower rate than the frames move the tissue as longer frames would.
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

void skip(Stage& stage, double dt_s = kFrame_s) {
  stage.time_s += dt_s;
  REQUIRE(stage.world.skip_pose(stage.blocks[0]).ok());
  stage.world.step(static_cast<float>(dt_s));
}

}  // namespace

TEST_CASE("a_pose_that_is_skipped_of_no_instance_is_refused") {
  Stage stage;
  CHECK(stage.world.skip_pose({}).code == StatusCode::kStaleId);
  REQUIRE(stage.world.destroy_instance(stage.blocks[0]).ok());
  CHECK(stage.world.skip_pose(stage.blocks[0]).code == StatusCode::kStaleId);
}

// Two, four frames are one of that length, but for how their times are summed.
TEST_CASE("a_pose_in_every_few_frames_is_a_frame_of_that_length") {
  for (const int every : {2, 4}) {
    Stage sparse(1, {.budget_mode = BudgetMode::kWorkUnits}),
        whole(1, {.budget_mode = BudgetMode::kWorkUnits});
    for (Stage* stage : {&sparse, &whole}) stage->step(scenes::walk, every * kFrame_s);
    for (int f = 0; f < 60; ++f) {
      const std::vector<float> before = sparse.read();
      for (int k = 1; k < every; ++k) {
        skip(sparse);
        CHECK(sparse.read() == before);
      }
      sparse.step(scenes::walk, kFrame_s);
      whole.time_s = sparse.time_s;
      whole.pose(whole.blocks[0], scenes::walk(whole.time_s));
      whole.world.step(static_cast<float>(every * kFrame_s));
      REQUIRE(test::largest_distance(sparse.read(), whole.read()) < 1e-6);
    }
  }
}

// What a character of dense poses reaches at most.
TEST_CASE("sparse_poses_swing_no_further_than_dense_ones") {
  const auto peak = [](int every) {
    Stage stage;
    double most = 0;
    for (int f = 0; f < 300; ++f) {
      if ((f + 1) % every == 0)
        stage.step(scenes::walk, kFrame_s);
      else
        skip(stage);
      most = std::max(most, static_cast<double>(test::largest_length(stage.read(0, Space::kBind))));
    }
    return most;
  };
  const double dense = peak(1);
  for (const auto& [every, most] : {std::pair{2, 1.1}, {4, 1.2}}) {
    const double sparse = peak(every);
    CHECK(sparse < most * dense);
    CHECK(sparse > 0.8 * dense);
  }
}

TEST_CASE("a_skipped_pose_beside_a_set_one_is_nothing") {
  for (const bool first : {false, true}) {
    Stage stage, usual;
    for (int f = 0; f < 30; ++f) {
      const double time_s = f * kFrame_s;
      if (first) REQUIRE(stage.world.skip_pose(stage.blocks[0]).ok());
      stage.pose(stage.blocks[0], scenes::walk(time_s));
      if (!first) REQUIRE(stage.world.skip_pose(stage.blocks[0]).ok());
      usual.pose(usual.blocks[0], scenes::walk(time_s));
      stage.world.step(static_cast<float>(kFrame_s));
      usual.world.step(static_cast<float>(kFrame_s));
      REQUIRE(stage.read() == usual.read());
    }
  }
}

// A step that says neither holds the pose, for all the time that was skipped as well.
TEST_CASE("without_a_pose_that_ends_it_what_was_skipped_counts_as_held") {
  Stage skipped, held;
  for (Stage* stage : {&skipped, &held}) stage->play(scenes::walk, 1);
  skip(skipped);
  skipped.world.step(static_cast<float>(kFrame_s));
  held.world.step(static_cast<float>(2 * kFrame_s));
  CHECK(skipped.read() == held.read());
}

TEST_CASE("a_snapshot_holds_the_time_without_poses") {
  Stage stage;
  stage.play(scenes::walk, 1);
  skip(stage);
  const std::vector<std::byte> saved = stage.save();
  const double saved_s = stage.time_s;
  const auto go_on = [&] {
    stage.time_s = saved_s;
    skip(stage);
    stage.step(scenes::walk, kFrame_s);
    return stage.read();
  };
  const std::vector<float> first = go_on();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  CHECK(go_on() == first);
}

TEST_CASE("who_waits_for_a_pose_is_counted_as_what_it_is_and_costs_no_tick") {
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
  stage.play(scenes::walk, 1);
  REQUIRE(stage.world.skip_pose(stage.blocks[0]).ok());
  const FrameReport report = stage.world.step(static_cast<float>(kFrame_s));
  CHECK(report.instances_network == 1);
  CHECK(report.instances_dormant == 0);
  CHECK(report.ticks == 0);
}

TEST_CASE("who_rests_sleeps_on_through_skipped_poses_and_wakes_over_their_time") {
  const auto stands = [](double) { return scenes::bind_pose(); };
  const auto rested = [&](Stage& stage) {
    stage.play(stands, 8);
    REQUIRE(stage.report().dormant);
  };
  Stage sparse(1, {.budget_mode = BudgetMode::kWorkUnits}), whole(1, {.budget_mode = BudgetMode::kWorkUnits});
  rested(sparse);
  rested(whole);
  skip(sparse);
  skip(sparse);
  CHECK(sparse.report().dormant);
  for (Stage* stage : {&sparse, &whole}) stage->pose(stage->blocks[0], scenes::bent_pose(0.05));
  sparse.world.step(static_cast<float>(kFrame_s));
  whole.world.step(static_cast<float>(3 * kFrame_s));
  CHECK(sparse.read() == whole.read());
}

TEST_CASE("a_pose_that_is_set_again_at_rest_is_no_skipped_one") {
  const auto stands = [](double) { return scenes::bind_pose(); };
  Stage sparse(1, {.budget_mode = BudgetMode::kWorkUnits}), usual(1, {.budget_mode = BudgetMode::kWorkUnits});
  for (Stage* stage : {&sparse, &usual}) {
    stage->play(stands, 8);
    REQUIRE(stage->report().dormant);
    stage->pose(stage->blocks[0], scenes::bind_pose());
  }
  REQUIRE(sparse.world.skip_pose(sparse.blocks[0]).ok());
  for (Stage* stage : {&sparse, &usual}) {
    stage->world.step(static_cast<float>(kFrame_s));
    stage->pose(stage->blocks[0], scenes::bent_pose(0.05));
    stage->world.step(static_cast<float>(kFrame_s));
  }
  CHECK(sparse.read() == usual.read());
}

TEST_CASE("a_reset_forgets_what_was_skipped") {
  Stage skipped, usual;
  for (Stage* stage : {&skipped, &usual}) stage->play(scenes::walk, 1);
  for (int f = 0; f < 3; ++f) skip(skipped);
  REQUIRE(skipped.world.skip_pose(skipped.blocks[0]).ok());
  for (Stage* stage : {&skipped, &usual}) {
    REQUIRE(stage->world.reset(stage->blocks[0]).ok());
    stage->time_s = 3;
    stage->play(scenes::walk, 0.5);
  }
  CHECK(skipped.read() == usual.read());
}

// Out of sight there is no motion that could wait.
TEST_CASE("who_is_hidden_forgets_what_was_skipped") {
  Stage stage;
  stage.play(scenes::walk, 1);
  for (int f = 0; f < 3; ++f) skip(stage);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], true).ok());
  stage.step(scenes::walk, kFrame_s);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
  stage.pose(stage.blocks[0], scenes::walk(stage.time_s));
  CHECK(stage.world.step(static_cast<float>(kFrame_s)).ticks == 1);
}

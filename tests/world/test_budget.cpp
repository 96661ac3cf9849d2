// test_budget.cpp  What a budget buys, seen through a clock that the test turns.
#include <atomic>
#include <limits>

#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Each look at it takes `look_us`, so that work costs time without being work.
struct FakeClock {
  std::atomic<uint64_t> now_ns{0};
  double look_us = 10;
  ClockHook hook() {
    const auto look = [](void* context) -> uint64_t {
      auto& clock = *static_cast<FakeClock*>(context);
      return clock.now_ns += static_cast<uint64_t>(clock.look_us * 1e3);
    };
    return {.now_ns = look, .context = this};
  }
};

// What one network instance adds to a step of this clock, in looks: begin, drive, tissue, end of it, ticked,
// published.
constexpr double kLooks = 6;

// Work units that pay for `seats` blocks' tick and not for one more.
float budget_for_us(uint32_t seats) {
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
  float one_us = 100;
  const auto affordable = [&] { return stage.step(scenes::walk, 1.0 / 60).instances_network == 1; };
  while (stage.world.set_budget_us(one_us).ok() && affordable()) one_us *= 0.95f;
  return one_us / 0.95f * (static_cast<float>(seats) + 0.05f);
}

}  // namespace

TEST_CASE("infinite_budget_runs_the_network_for_all") {
  Stage stage(5);
  const FrameReport report = stage.step(scenes::walk, 1.0 / 60);
  CHECK(report.instances_network == 5);
  CHECK(report.budget_us == kInfinity);
  CHECK_FALSE(report.over_budget);
  CHECK(stage.report().tier == Tier::kNetwork);
  CHECK(stage.report().blend == 1);
}

TEST_CASE("budget_zero_skins_all_and_moves_smoothly_there") {
  Stage stage(3);
  stage.play(scenes::walk, 1);
  REQUIRE(stage.world.set_budget_us(0).ok());
  stage.play(scenes::walk, 1);
  const FrameReport report = stage.step(scenes::walk, 1.0 / 60);
  CHECK(report.instances_skinned == 3);
  CHECK(report.instances_network == 0);
  CHECK(report.tissue_us == 0);
  CHECK(stage.report().blend == 0);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) == 0);
}

TEST_CASE("late_instances_are_cut_counted_and_extrapolated") {
  FakeClock clock;
  Stage stage(5, {.clock = clock.hook()});
  // The baked cost of the small network is below 1 us: all five are scheduled, but time runs out after two.
  REQUIRE(stage.world.set_budget_us(static_cast<float>(2 * kLooks * clock.look_us)).ok());
  const FrameReport report = stage.step(scenes::walk, 1.0 / 60);
  CHECK(report.instances_network == 2);
  CHECK(report.instances_cut == 3);
  CHECK(report.over_budget);
}

TEST_CASE("costs_are_corrected_until_nobody_is_cut") {
  FakeClock clock;
  Stage stage(8, {.clock = clock.hook()});
  const double network_us = 3 * clock.look_us, base_us = 3 * clock.look_us;
  const double budget_us = 8 * base_us + 3.5 * network_us + 4 * clock.look_us;
  REQUIRE(stage.world.set_budget_us(static_cast<float>(budget_us)).ok());
  stage.play(scenes::walk, 5);
  uint32_t cut = 0, over = 0, network = 0;
  constexpr uint32_t kFrames = 120;
  for (uint32_t f = 0; f < kFrames; ++f) {
    const FrameReport report = stage.step(scenes::walk, 1.0 / 60);
    cut += report.instances_cut;
    over += report.over_budget;
    network += report.instances_network;
  }
  WARN("of " << kFrames << " frames over budget " << over << ", cut instances " << cut << ", network a frame "
             << static_cast<double>(network) / kFrames);
  CHECK(cut == 0);
  CHECK(over <= kFrames / 20);
  CHECK(network >= 2 * kFrames);
}

TEST_CASE("report_counts_every_instance_once_and_measures_its_stages") {
  FakeClock clock;
  Stage stage(6, {.clock = clock.hook()});
  REQUIRE(stage.world.set_budget_us(400).ok());
  for (int f = 0; f < 60; ++f) {
    const FrameReport report = stage.step(scenes::walk, 1.0 / 60);
    CHECK(report.frame == static_cast<uint64_t>(f));
    CHECK(report.instances_network + report.instances_modal + report.instances_spring +
              report.instances_extrapolated + report.instances_skinned ==
          6);
    const float stages_us =
        report.schedule_us + report.drive_us + report.tissue_us + report.rods_us + report.publish_us;
    CHECK(stages_us > 0);
    CHECK(stages_us < report.total_us);
  }
}

TEST_CASE("in_work_units_the_clock_does_not_matter") {
  FakeClock slow{.look_us = 1000}, fast{.look_us = 0.1};
  Stage a(7, {.budget_mode = BudgetMode::kWorkUnits, .clock = slow.hook()});
  Stage b(7, {.budget_mode = BudgetMode::kWorkUnits, .clock = fast.hook()});
  for (Stage* stage : {&a, &b}) REQUIRE(stage->world.set_budget_us(budget_for_us(3)).ok());
  uint32_t network = 0;
  for (int f = 0; f < 300; ++f) {
    const FrameReport report_a = a.step(scenes::walk, 1.0 / 60), report_b = b.step(scenes::walk, 1.0 / 60);
    CHECK(report_a.instances_network == report_b.instances_network);
    CHECK(report_a.over_budget == report_b.over_budget);
    network += report_a.instances_network;
    for (size_t i = 0; i < 7; ++i) CHECK(a.read(i) == b.read(i));
  }
  CHECK(network == 3 * 300);
}

// The rule of frame/scheduler.hpp, through the world: every instance comes to its turn.
TEST_CASE("nobody_waits_longer_than_the_stated_bound") {
  constexpr size_t kCount = 9, kSeats = 2;
  Stage stage(0, {.budget_mode = BudgetMode::kWorkUnits});
  for (size_t i = 0; i < kCount; ++i) stage.add(i == 0 ? 1e-3f : 1000);
  REQUIRE(stage.world.set_budget_us(budget_for_us(kSeats)).ok());
  const double bound_s = 2 + std::ceil(double{kCount} / kSeats) * (0.5 + 1.0 / 60);
  uint32_t longest_ticks = 0;
  for (int f = 0; f < 60 * 30; ++f) {
    stage.step(scenes::walk, 1.0 / 60);
    for (size_t i = 0; i < kCount; ++i)
      longest_ticks = std::max(longest_ticks, stage.report(i).ticks_since_network);
  }
  WARN("longest wait " << longest_ticks / 60.0 << " s, bound " << bound_s << " s");
  CHECK(longest_ticks / 60.0 <= bound_s);
  CHECK(longest_ticks > 60);
}

TEST_CASE("importance_that_is_no_weight_counts_as_zero") {
  Stage stage(0, {.budget_mode = BudgetMode::kWorkUnits});
  stage.add(std::numeric_limits<float>::quiet_NaN());
  stage.add(-5);
  stage.add(1);
  REQUIRE(stage.world.set_budget_us(budget_for_us(1)).ok());
  stage.step(scenes::walk, 1.0 / 60);
  CHECK(stage.report(2).tier == Tier::kNetwork);
  REQUIRE(stage.world.set_importance(stage.blocks[2], -kInfinity).ok());
  REQUIRE(stage.world.set_importance(stage.blocks[0], kInfinity).ok());
  stage.play(scenes::walk, 1);
  CHECK(stage.report(0).tier == Tier::kNetwork);
}

// At 240 frames a second three of four steps have no tick: tiers are not touched by them.
TEST_CASE("frames_between_ticks_keep_tiers_and_cost_no_network") {
  Stage stage(4);
  stage.play(scenes::walk, 0.5, 240);
  for (int f = 0; f < 8; ++f) {
    const FrameReport report = stage.step(scenes::walk, 1.0 / 240);
    CHECK(report.instances_network == 4);
    CHECK((report.tissue_us > 0) == (report.ticks > 0));
  }
}

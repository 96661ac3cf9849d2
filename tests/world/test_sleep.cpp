// test_sleep.cpp  Regions at rest are left out, wake in the tick that moves them, and are hardly missed.
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kTolerance = 2e-4f;

WorldDef with_tolerance(float tolerance) {
  return {.sleep_tolerance = tolerance, .budget_mode = BudgetMode::kWorkUnits};
}

// Walks, stands, walks on.
scenes::BlockPose walk_and_rest(double time_s) {
  constexpr double kWalk_s = 2, kRest_s = 8;
  const double walked = time_s < kWalk_s ? time_s : std::max(kWalk_s, time_s - kRest_s);
  return scenes::walk(walked);
}

double region_radius_m() {
  pack::PackView view;
  REQUIRE(pack::open_pack(test::block_pack().bytes(), &view).ok());
  return static_cast<double>(view.regions[0].radius_m);
}

uint64_t hash_of_rest(const TaskHook& tasks) {
  WorldDef def = with_tolerance(kTolerance);
  def.tasks = tasks;
  Stage stage(5, def);
  std::vector<float> seen;
  for (int f = 0; f < 640; ++f) {
    stage.step(walk_and_rest, kFrame_s);
    for (size_t i = 0; i < stage.blocks.size(); ++i) {
      const std::vector<float> places = stage.read(i);
      seen.insert(seen.end(), places.begin(), places.end());
    }
  }
  return test::hash_of(seen);
}

}  // namespace

TEST_CASE("a_sleep_tolerance_outside_its_range_is_refused") {
  for (const float bad : {-1e-6f, 1.1f, NAN, std::numeric_limits<float>::infinity()}) {
    World world;
    CHECK(World::create({.sleep_tolerance = bad}, &world).code == StatusCode::kInvalidArgument);
  }
}

TEST_CASE("a_region_that_stands_falls_asleep_and_wakes_in_the_tick_that_moves_it") {
  Stage stage(1, with_tolerance(kTolerance));
  stage.play(walk_and_rest, 2);
  REQUIRE(stage.report().regions_asleep == 0);
  stage.play(walk_and_rest, 7.8);
  REQUIRE(stage.report().regions_asleep == 2);
  const std::vector<float> asleep = stage.read();
  stage.pose(stage.blocks[0], walk_and_rest(2));
  REQUIRE(stage.world.step(static_cast<float>(kFrame_s)).regions_asleep == 2);
  CHECK(stage.read() == asleep);
  // 1 mm in a tick is 3.6 m/s^2: nothing that it may sleep through.
  scenes::BlockPose moved = walk_and_rest(2);
  moved.root.position_m[0] += 1e-3;
  stage.pose(stage.blocks[0], moved);
  CHECK(stage.world.step(static_cast<float>(kFrame_s)).regions_asleep == 0);
  CHECK(test::largest_distance(stage.read(), asleep) > 1e-6);
}

TEST_CASE("without_a_tolerance_nothing_sleeps_even_in_a_still_bind_pose") {
  Stage stage(1, with_tolerance(0));
  stage.play([](double) { return scenes::bind_pose(); }, 2);
  CHECK(stage.report().regions_asleep == 0);
  Stage other(1, with_tolerance(kTolerance));
  other.play([](double) { return scenes::bind_pose(); }, 2);
  CHECK(other.report().regions_asleep == 2);
}

// A swing of the tolerance is cut off when it falls asleep, and what it feels less than that may add as much
// at rest, 1 / (2 x 0.1) as much at resonance: six tolerances of the region's radius, at every vertex, then
// and after it has woken; the block's vertices move by what its nodes move.
TEST_CASE("sleeping_adds_no_more_than_its_tolerance_says") {
  for (const float tolerance : {2e-4f, 2e-3f}) {
    Stage sleeper(1, with_tolerance(tolerance)), waker(1, with_tolerance(0));
    double worst_m = 0;
    uint32_t ticks_asleep = 0;
    for (int f = 0; f < 800; ++f) {
      ticks_asleep += sleeper.step(walk_and_rest, kFrame_s).regions_asleep;
      waker.step(walk_and_rest, kFrame_s);
      worst_m = std::max(worst_m, test::largest_distance(sleeper.read(), waker.read()));
    }
    CAPTURE(tolerance, worst_m, ticks_asleep);
    CHECK(ticks_asleep > 60);
    CHECK(worst_m > 0);
    CHECK(worst_m <= 6 * static_cast<double>(tolerance) * region_radius_m());
  }
}

TEST_CASE("sleep_is_part_of_the_snapshot") {
  Stage stage(1, with_tolerance(kTolerance));
  const auto play = [&](int frames) {
    std::vector<uint64_t> hashes;
    for (int f = 0; f < frames; ++f) {
      stage.step(walk_and_rest, kFrame_s);
      hashes.push_back(test::hash_of(stage.read()));
    }
    return hashes;
  };
  for (const int frames :
       {240, 500}) {  // about to fall asleep, or asleep; from there into sleep and out of it
    play(frames);
    const std::vector<std::byte> saved = stage.save();
    const double time_s = stage.time_s;
    const uint32_t asleep = stage.report().regions_asleep;
    const std::vector<uint64_t> first = play(300);
    REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
    CHECK(stage.report().regions_asleep == asleep);
    stage.time_s = time_s;
    CHECK(play(300) == first);
    stage.time_s = 0;
    REQUIRE(stage.world.reset(stage.blocks[0]).ok());
  }
}

TEST_CASE("sleepers_have_the_same_bits_for_any_number_of_workers") {
  const uint64_t serial = hash_of_rest({});
  for (const uint32_t workers : {2u, 4u}) {
    scenes::ThreadPool pool(workers);
    CHECK(hash_of_rest(pool.hook()) == serial);
  }
}

// The other region goes on as if it were alone.
TEST_CASE("one_region_sleeps_while_the_other_moves") {
  int alone = 0;
  for (const double angle : {0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5}) {
    const auto lean = [angle](double time_s) { return scenes::bent_pose(angle * std::min(time_s, 1.0)); };
    Stage stage(1, with_tolerance(kTolerance));
    for (int f = 0; f < 800; ++f) alone += stage.step(lean, kFrame_s).regions_asleep == 1;
    CHECK(stage.report().regions_asleep == 2);
  }
  CHECK(alone > 0);  // they are alike, and fall asleep a few ticks apart at most
}

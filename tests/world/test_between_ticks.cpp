// test_between_ticks.cpp  What is shown between ticks leads through them without a jump, and changes none.
#include <algorithm>

#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kTick_s = 1.0 / 60;

using Shown = std::vector<std::vector<float>>;

float largest_move(const std::vector<float>& a, const std::vector<float>& b) {
  return static_cast<float>(test::largest_distance(a, b));
}

// The largest move of a frame over the larger of those beside it, or half of the usual move where these are
// less.
float judder(const Shown& shown) {
  std::vector<float> moves;
  for (size_t f = 1; f < shown.size(); ++f) moves.push_back(largest_move(shown[f], shown[f - 1]));
  std::vector<float> sorted = moves;
  std::ranges::sort(sorted);
  const float least = sorted[sorted.size() / 2] / 2;
  float most = 0;
  for (size_t f = 1; f + 1 < moves.size(); ++f) {
    const float beside = std::max({moves[f - 1], moves[f + 1], least});
    most = std::max(most, moves[f] / beside);
  }
  return most;
}

std::vector<float> deltas(const Stage& stage) { return stage.read(0, Space::kBind); }

// After a second at 60 frames a second, what is shown of so many frames of the time given.
Shown played(Stage& stage, const test::Motion& motion, double frame_s, int frames) {
  stage.play(motion, 1);
  Shown out;
  for (int f = 0; f < frames; ++f) {
    stage.step(motion, frame_s);
    out.push_back(deltas(stage));
  }
  return out;
}

// Of the tail and the horns, how rods have turned what the pose has; entries of matrices.
Shown played_rods(Stage& stage, const test::Motion& motion, double frame_s, int frames) {
  double time_s = 0;
  const auto step = [&](double dt_s) {
    time_s += dt_s;
    const scenes::TailedPose pose = scenes::with_rods(motion(time_s));
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
    stage.world.step(static_cast<float>(dt_s));
    std::vector<float> off = test::joints_of(stage);
    const Pose given = pose.pose();
    for (size_t j = 0; j < given.joints.size(); ++j)
      for (size_t k = 0; k < 12; ++k) off[12 * j + k] -= (&given.joints[j].m[0][0])[k];
    return off;
  };
  for (int f = 0; f < 60; ++f) step(kTick_s);
  Shown out;
  for (int f = 0; f < frames; ++f) out.push_back(step(frame_s));
  return out;
}

// To and fro at 70 m/s^2.
scenes::BlockPose wild(double time_s) {
  return scenes::bent_pose(0.1, 0.2 * std::sin(2 * 3.14159265 * 3 * time_s));
}

double swing(double time_s) { return 0.04 * std::sin(2 * 3.14159265 * 2 * time_s); }

}  // namespace

// 1.3 is asked; extrapolation with the last velocity gave 4 to 88.
TEST_CASE("what_is_shown_goes_through_ticks_without_a_jump") {
  for (const bool network : {false, true})
    for (const auto& motion :
         {test::Motion(scenes::walk), test::Motion([](double t) { return scenes::shake(t); })})
      for (const double frame_s : {kTick_s / 4, kTick_s / 2.4, kTick_s / 50}) {
        Stage stage(1, {}, network ? test::block_pack() : test::weightless_pack());
        const float most = judder(played(stage, motion, frame_s, 400));
        CAPTURE(network, frame_s, most);
        CHECK(most < 1.3f);
      }
}

// Of a network's corrections what is taken is scaled with what swings.
TEST_CASE("flesh_that_is_held_at_its_limit_goes_through_ticks_without_a_jump") {
  for (const bool network : {false, true})
    for (const double frame_s : {kTick_s / 4, kTick_s / 2.4, kTick_s / 50}) {
      Stage stage(1, {}, network ? test::block_pack() : test::weightless_pack());
      const float most = judder(played(stage, wild, frame_s, 400));
      CAPTURE(network, frame_s, most);
      CHECK(stage.report().displacement_clamps > 10);
      CHECK(most < (network ? 1.8f : 1.3f));
    }
}

TEST_CASE("rods_that_are_held_at_their_limit_go_through_ticks_without_a_jump") {
  const scenes::PackBytes pack =
      scenes::soft_block({.network = false, .rods = scenes::RodMatter{.max_displacement = 0.2}});
  for (const double frame_s : {kTick_s / 4, kTick_s / 2.4, kTick_s / 50}) {
    Stage stage(1, {}, pack);
    const float most = judder(played_rods(stage, wild, frame_s, 400));
    CAPTURE(frame_s, most);
    CHECK(most < 1.3f);
  }
}

TEST_CASE("rods_go_through_ticks_without_a_jump") {
  for (const double frame_s : {kTick_s / 4, kTick_s / 2.4, kTick_s / 50}) {
    Stage stage(1, {}, test::tailed_pack());
    const float most = judder(played_rods(stage, scenes::walk, frame_s, 400));
    CAPTURE(frame_s, most);
    CHECK(most < 1.3f);
  }
}

// The last of a hundred frames a tick lies where the tick will: of the tick's own move 2 % are allowed.
TEST_CASE("the_end_of_a_tick_is_where_the_next_one_begins") {
  constexpr int kFrames = 100;
  for (const bool network : {false, true}) {
    Stage stage(1, {}, network ? test::block_pack() : test::weightless_pack());
    const Shown shown = played(stage, scenes::walk, kTick_s / kFrames, 20 * kFrames);
    double worst = 0;
    for (size_t tick = 2; tick < 20; ++tick) {
      const size_t at =
          tick * kFrames - 1;  // the tick's own frame; half of what a frame moves is the frame's
      const double jump_m = test::largest_distance(shown[at], shown[at - 1]),
                   frame_m = test::largest_distance(shown[at - 1], shown[at - 2]),
                   tick_m = test::largest_distance(shown[at], shown[at - kFrames]);
      worst = std::max(worst, (jump_m - frame_m) / tick_m);
    }
    CAPTURE(network, worst);
    CHECK(worst < 0.02);
  }
}

// Frames of a fifth of a tick or longer: in shorter ones the difference of a network's correction from what
// was expected is faded within the tick, and the frame on the tick has the whole of it.
TEST_CASE("frames_on_ticks_show_the_same_whatever_lies_between") {
  for (const int frames : {2, 4}) {
    Stage coarse, fine;
    for (int tick = 0; tick < 90; ++tick) {
      coarse.step(scenes::walk, kTick_s);
      for (int f = 0; f < frames; ++f) fine.step(scenes::walk, kTick_s / frames);
      // Poses at ticks are those that were set; the ones before the first are made up by frames.
      CHECK(test::largest_distance(deltas(coarse), deltas(fine)) < 2e-5);
    }
  }
}

TEST_CASE("between_ticks_nothing_is_shown_beyond_the_limit") {
  pack::PackView view;
  REQUIRE(pack::open_pack(test::weightless_pack().bytes(), &view).ok());
  float limit_m = 0;
  for (const pack::RegionRecord& region : view.regions)
    limit_m = std::max(limit_m, region.displacement_limit_m);
  const auto shaken = [](double time_s) { return scenes::shake(time_s, 4); };
  Stage stage(1, {}, test::weightless_pack());
  double most_m = 0;
  for (int f = 0; f < 600; ++f) {
    stage.step(shaken, 1.0 / 144);
    most_m = std::max(most_m, static_cast<double>(test::largest_length(deltas(stage))));
  }
  // A vertex is carried by nodes of its region with weights that add up to one at most.
  CHECK(stage.report().displacement_clamps > 0);
  CHECK(most_m <= 1.0001 * static_cast<double>(limit_m));
}

// As it rests in its bind pose: under gravity alone nothing moves, whatever the fraction.
TEST_CASE("what_rests_is_at_rest_between_ticks") {
  Stage stage(1, {.sleep_tolerance = 0}, test::weightless_pack());
  const auto leans = [](double time_s) { return scenes::bent_pose(0.4 * std::min(1.0, time_s)); };
  stage.play(leans, 12);
  const std::vector<float> rests = deltas(stage);
  const double rests_m = test::largest_length(rests);
  REQUIRE(rests_m > 1e-4);
  for (int f = 0; f < 40; ++f) {
    stage.step(leans, kTick_s / 7);
    CHECK(test::largest_distance(deltas(stage), rests) < 1e-3 * rests_m);
  }
}

TEST_CASE("a_snapshot_between_ticks_shows_what_was_shown_and_goes_on_with_the_same_bits") {
  for (const scenes::PackBytes* pack : {&test::block_pack(), &test::tailed_pack()}) {
    Stage stage(1, {}, *pack);
    double time_s = 0;
    const auto step = [&] {
      time_s += kTick_s / 3.7;
      const scenes::BlockPose pose = scenes::walk(time_s);
      const scenes::TailedPose tailed = scenes::with_rods(pose);
      REQUIRE(
          stage.world.set_pose(stage.blocks[0], pack == &test::tailed_pack() ? tailed.pose() : pose.pose())
              .ok());
      stage.world.step(static_cast<float>(kTick_s / 3.7));
      return test::hash_of(stage.read()) ^ test::hash_of(test::joints_of(stage));
    };
    for (int f = 0; f < 122; ++f) step();
    const uint64_t shown = test::hash_of(stage.read()) ^ test::hash_of(test::joints_of(stage));
    const std::vector<std::byte> saved = stage.save();
    const double saved_s = time_s;
    std::vector<uint64_t> first, again;
    for (int f = 0; f < 30; ++f) first.push_back(step());
    REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
    CHECK((test::hash_of(stage.read()) ^ test::hash_of(test::joints_of(stage))) == shown);
    time_s = saved_s;
    for (int f = 0; f < 30; ++f) again.push_back(step());
    CHECK(first == again);
  }
}

// At rest against a wall each tick pushes as the one before did: what is pressed does not fall in between.
TEST_CASE("what_is_pressed_does_not_tremble_between_ticks") {
  scenes::HalfSpaces wall;
  wall.walls = {{{0.14, 0, 0}, {-1, 0, 0}}};
  Stage stage(0, {.sleep_tolerance = 0}, test::weightless_pack());
  InstanceId made;
  REQUIRE(stage.world.create_instance({.asset = stage.asset, .contacts = {.source = &wall}}, &made).ok());
  stage.blocks.push_back(made);
  const auto stands = [](double) { return scenes::bind_pose(); };
  stage.play(stands, 20);
  REQUIRE(stage.report().vertices_touched > 0);
  // What trembles from tick to tick is not of this.
  double ticks_m = 0, frames_m = 0;
  std::vector<float> last = deltas(stage), on_tick = last;
  for (int f = 1; f <= 80; ++f) {
    stage.step(stands, kTick_s / 4);
    const std::vector<float> now = deltas(stage);
    frames_m = std::max(frames_m, test::largest_distance(now, last));
    last = now;
    if (f % 4 != 0) continue;
    ticks_m = std::max(ticks_m, test::largest_distance(now, on_tick));
    on_tick = now;
  }
  CHECK(frames_m < 1.3 * ticks_m + 2e-4);
}

// A pause between two ticks under another pose, which in no time is a teleport: the pose moves, the tissue
// does not.
TEST_CASE("a_pause_between_ticks_takes_nothing_back") {
  Stage stage(1, {}, test::weightless_pack());
  stage.play(scenes::walk, 1);
  const std::vector<float> on_tick = deltas(stage);
  stage.step(scenes::walk, 0.9 * kTick_s);
  const std::vector<float> shown = deltas(stage);
  scenes::BlockPose pose = scenes::walk(stage.time_s);
  pose.joints[1].m[0][3] += 1e-3f;
  stage.pose(stage.blocks[0], pose);
  stage.world.step(0);
  CHECK(test::largest_distance(deltas(stage), shown) < 0.2 * test::largest_distance(shown, on_tick));
}

// Back in simulation a blend goes on between ticks at its last pace, which each tick finds anew; all of a
// tick's way in one frame would be four times the others.
TEST_CASE("what_is_blended_in_goes_on_between_ticks") {
  for (const scenes::PackBytes* pack : {&test::weightless_pack(), &test::block_pack()}) {
    Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits}, *pack);
    stage.play(scenes::walk, 1);
    REQUIRE(stage.world.set_budget_us(0).ok());
    stage.play(scenes::walk, 0.5);
    REQUIRE(stage.world.set_budget_us(1e9f).ok());
    Shown shown;
    for (int f = 0; f < 4 * 18; ++f) {
      stage.step(scenes::walk, kTick_s / 4);
      shown.push_back(deltas(stage));
    }
    CHECK(judder({shown.begin() + 4, shown.end()}) < 2.5f);
  }
}

// Left to itself, what moved goes on between ticks as it will have gone by the next one.
TEST_CASE("what_is_no_longer_simulated_goes_through_ticks_without_a_jump") {
  for (const double frame_s : {kTick_s / 4, kTick_s / 50}) {
    Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits}, test::weightless_pack());
    const auto sways = [](double time_s) { return scenes::bent_pose(swing(time_s)); };
    stage.play(sways, 1.1);
    REQUIRE(stage.world.set_budget_us(1e-4f).ok());
    stage.step(sways, kTick_s);
    Shown shown{deltas(stage)};
    for (int f = 0; f < 3 * std::lround(kTick_s / frame_s); ++f) {
      stage.step(sways, frame_s);
      shown.push_back(deltas(stage));
    }
    CAPTURE(frame_s);
    CHECK(stage.report().tier == Tier::kExtrapolate);
    CHECK(judder(shown) < 1.3f);
  }
}

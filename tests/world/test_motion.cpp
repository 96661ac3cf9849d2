// test_motion.cpp  What tissue feels: rest, first poses, frame rates, teleports, pauses, hitches, places far
// away.
#include <limits>

#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

std::vector<float> deltas(const Stage& stage) { return stage.read(0, Space::kBind); }

// The same motion as if the character had been moved rigidly to another place and heading.
scenes::BlockPose moved(const scenes::BlockPose& pose, double x_m, double z_m) {
  scenes::BlockPose result = pose;
  // A quarter turn about y: (x, z) goes to (z, -x).
  const double turned_x = pose.root.position_m[2], turned_z = -pose.root.position_m[0];
  result.root.position_m[0] = turned_x + x_m;
  result.root.position_m[2] = turned_z + z_m;
  const float h = std::sqrt(0.5f);
  const float* q = pose.root.rotation_xyzw;
  const float turned[4] = {h * q[0] + h * q[2], h * q[1] + h * q[3], h * q[2] - h * q[0],
                           h * q[3] - h * q[1]};
  std::copy_n(turned, 4, result.root.rotation_xyzw);
  return result;
}

// Largest bind-space displacement of any vertex in each frame of `seconds`.
double largest_delta(Stage& stage, const test::Motion& motion, double seconds) {
  double largest = 0;
  for (int f = 0; f < static_cast<int>(seconds * 60); ++f) {
    stage.step(motion, kFrame_s);
    largest = std::max(largest, test::largest_length(deltas(stage)));
  }
  return largest;
}

}  // namespace

TEST_CASE("bind_pose_at_rest_is_a_fixed_point") {
  Stage stage;
  CHECK(largest_delta(
            stage, [](double) { return scenes::bind_pose(); }, 3) == 0);
}

TEST_CASE("first_pose_counts_as_held_for_ever") {
  Stage stage;
  const auto bent_far_away = [](double) { return scenes::bent_pose(0.7, 50); };
  // Gravity has turned against the upper joint; nothing has moved. Only that small static pull may show.
  stage.step(bent_far_away, kFrame_s);
  // What turning by the bend changes of it; the tip of the first mode goes further than the nodes' mean.
  const double kOneTickOfGravity_m = 2 * std::sin(0.35) * 9.81 / 3600 * 2.3;
  CHECK(test::largest_length(deltas(stage)) < kOneTickOfGravity_m);
}

TEST_CASE("reset_forgets_motion_and_the_next_pose_is_at_rest") {
  Stage stage, fresh;
  stage.play([](double t) { return scenes::shake(t); }, 2);
  REQUIRE(test::largest_length(deltas(stage)) > 0.01);
  REQUIRE(stage.world.reset(stage.blocks[0]).ok());
  for (int f = 0; f < 30; ++f) {
    for (Stage* each : {&stage, &fresh}) {
      each->pose(each->blocks[0], scenes::walk(1 + f * kFrame_s));
      each->world.step(static_cast<float>(kFrame_s));
    }
    CHECK(deltas(stage) == deltas(fresh));
  }
}

TEST_CASE("moving_character_wobbles") {
  Stage stage;
  CHECK(largest_delta(stage, scenes::walk, 3) > 0.005);
  CHECK(stage.report().input_clamps == 0);
}

// The number that is published: the same motion, looked at every 0.2 s, at 15 to 120 frames a second against
// 240.
TEST_CASE("motion_is_the_same_at_every_frame_rate") {
  struct Row {
    double fps,
        bound_share;  // of the mean displacement; 15 and 30: a pose between two frames is guessed from three
  };
  constexpr Row kRows[] = {{15, 0.078}, {20, 0.034}, {30, 0.0095}, {60, 1e-3}, {120, 1e-3}};
  constexpr int kSamples = 25;
  const auto sample = [&](double fps) {
    Stage stage;
    std::vector<std::vector<float>> seen;
    for (int k = 0; k < kSamples; ++k) {
      stage.play(scenes::walk, 0.2, fps);
      seen.push_back(deltas(stage));
    }
    return seen;
  };
  const auto fine = sample(240);
  double size_m = 0;
  for (const auto& each : fine) size_m += test::largest_length(each) / kSamples;
  for (const Row& row : kRows) {
    const auto coarse = sample(row.fps);
    double mean_m = 0, worst_m = 0;
    for (int k = 0; k < kSamples; ++k) {
      const double off_m =
          test::largest_distance(coarse[static_cast<size_t>(k)], fine[static_cast<size_t>(k)]);
      mean_m += off_m / kSamples;
      worst_m = std::max(worst_m, off_m);
    }
    WARN(row.fps << " frames/s against 240: mean " << mean_m * 1e3 << " mm, worst " << worst_m * 1e3
                 << " mm, of a displacement of " << size_m * 1e3 << " mm");
    CHECK(mean_m < row.bound_share * size_m);
  }
}

// Between ticks a provisional step leads there. Truth: the cubic through the ticks around.
TEST_CASE("displacement_between_ticks_is_there_within_half_a_percent") {
  Stage stage;
  std::vector<std::vector<float>> at_ticks, half_way;
  for (int f = 0; f < 600; ++f) {
    stage.step(scenes::walk, 1.0 / 120);
    (f % 2 == 1 ? at_ticks : half_way).push_back(deltas(stage));
  }
  double shown_off_m = 0, late_m = 0, size_m = 0;
  for (size_t k = 60; k + 2 < at_ticks.size(); ++k) {
    std::vector<float> truth(at_ticks[k].size()), late(truth.size());
    for (size_t i = 0; i < truth.size(); ++i) {  // four-point midpoint between ticks k and k + 1
      truth[i] = (9 * (at_ticks[k][i] + at_ticks[k + 1][i]) - at_ticks[k - 1][i] - at_ticks[k + 2][i]) / 16;
      late[i] = (at_ticks[k][i] + at_ticks[k - 1][i]) / 2;  // what interpolating one tick late would show
    }
    shown_off_m += test::largest_distance(half_way[k + 1], truth);
    late_m += test::largest_distance(late, truth);
    size_m += test::largest_length(truth);
  }
  WARN("half a tick after a tick: " << 100 * shown_off_m / size_m << " % off, one tick late "
                                    << 100 * late_m / size_m << " % off");
  constexpr double kBound = 0.005;  // fourth order in 2 pi 3.5 Hz / 60; the last velocity alone: 0.02
  CHECK(shown_off_m < kBound * size_m);
}

TEST_CASE("a_million_metres_away_is_like_the_origin") {
  Stage near, far;
  const auto away = [](double t) {
    scenes::BlockPose pose = scenes::walk(t);
    pose.root.position_m[0] += 1e6;
    pose.root.position_m[2] -= 1e6;
    return pose;
  };
  double worst_m = 0;
  for (int f = 0; f < 300; ++f) {
    near.step(scenes::walk, kFrame_s);
    far.step(away, kFrame_s);
    worst_m = std::max(worst_m, test::largest_distance(deltas(near), deltas(far)));
  }
  // Doubles are 1.2e-10 m apart there: an acceleration of 1e-6 m/s^2 at 60 Hz, amplified by the resonance.
  constexpr double kBound_m = 1.2e-7;
  WARN("largest difference to the origin " << worst_m * 1e9 << " nm");
  CHECK(worst_m < kBound_m);
}

TEST_CASE("world_positions_far_away_are_relative_to_the_origin_asked_for") {
  Stage stage;
  scenes::BlockPose pose = scenes::bind_pose();
  pose.root.position_m[0] = 1e6 + 0.0137;
  stage.pose(stage.blocks[0], pose);
  stage.world.step(static_cast<float>(kFrame_s));
  std::vector<float> out(size_t{3} * stage.info.vertex_count);
  ReadDef def{.space = Space::kWorld, .out = out.data(), .capacity = stage.info.vertex_count};
  def.origin_m[0] = 1e6;
  REQUIRE(stage.world.read_positions(stage.blocks[0], def).ok());
  const std::vector<float> character = stage.read();
  for (size_t i = 0; i < out.size(); i += 3) CHECK(out[i] == Approx(character[i] + 0.0137).margin(1e-6));
}

// The jump goes to another place and heading; the walk goes on as if nothing had happened, and so does the
// tissue.
TEST_CASE("teleport_keeps_shape_and_is_not_felt") {
  for (const double fps : {60.0, 15.0}) {
    Stage walking, jumping;
    const auto jump = [](double t) { return t < 2 ? scenes::walk(t) : moved(scenes::walk(t), 3, 40); };
    double worst_m = 0, size_m = 0;
    for (int f = 0; f < static_cast<int>(4 * fps); ++f) {
      walking.step(scenes::walk, 1 / fps);
      jumping.step(jump, 1 / fps);
      worst_m = std::max(worst_m, test::largest_distance(deltas(walking), deltas(jumping)));
      size_m = std::max(size_m, test::largest_length(deltas(walking)));
    }
    WARN(fps << " frames/s: teleport changes the displacement by at most " << worst_m * 1e3 << " mm of "
             << size_m * 1e3 << " mm");
    // The acceleration of one step of unknown motion is lost: some 10 m/s^2 over a frame.
    const double bound_m = fps == 60 ? 0.003 : 0.02;
    CHECK(worst_m < bound_m);
  }
}

TEST_CASE("jump_below_the_teleport_distance_is_felt") {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  Stage stage(1, {.teleport = {.distance = 10, .acceleration = kNever}});
  stage.play([](double) { return scenes::bind_pose(); }, 0.5);
  stage.play([](double) { return scenes::bent_pose(0, 1.5); }, 0.1);
  CHECK(test::largest_length(deltas(stage)) > 0.005);
  CHECK(stage.report().input_clamps > 0);
}

TEST_CASE("fast_steady_travel_is_no_teleport_at_any_frame_rate") {
  for (const double fps : {15.0, 60.0}) {
    Stage stage;
    // 60 m/s: 4 m between two frames at 15 a second. Speeding up takes two seconds.
    const auto drive = [](double t) { return scenes::bent_pose(0, t < 2 ? 15 * t * t : 60 * (t - 1)); };
    stage.play(drive, 1.9, fps);
    const double leaning_m = test::largest_length(deltas(stage));
    CHECK(leaning_m > 0.02);  // 30 m/s^2 would be lost if each frame were taken for a teleport
  }
}

TEST_CASE("pause_changes_nothing") {
  Stage paused, running;
  for (int f = 0; f < 120; ++f) {
    paused.step(scenes::walk, kFrame_s);
    running.step(scenes::walk, kFrame_s);
    if (f % 20 == 0) {
      const std::vector<float> before = deltas(paused);
      CHECK(paused.step(scenes::walk, 0).ticks == 0);
      CHECK(deltas(paused) == before);
    }
    CHECK(deltas(paused) == deltas(running));
  }
}

TEST_CASE("pose_that_is_not_set_is_held") {
  Stage held, repeated;
  held.play(scenes::walk, 1);
  repeated.play(scenes::walk, 1);
  for (int f = 0; f < 30; ++f) {
    held.world.step(static_cast<float>(kFrame_s));
    repeated.pose(repeated.blocks[0], scenes::walk(1));
    repeated.world.step(static_cast<float>(kFrame_s));
    CHECK(deltas(held) == deltas(repeated));
  }
}

TEST_CASE("hitch_of_five_seconds_is_capped_reported_and_bounded") {
  Stage stage;
  const double usual_m = largest_delta(stage, scenes::walk, 3);
  const FrameReport report = stage.step(scenes::walk, 5);
  CHECK(report.ticks == 8);
  CHECK(report.dropped_s == Approx(5 - 8 * kFrame_s).epsilon(1e-5));
  const double after_m = std::max(test::largest_length(deltas(stage)), largest_delta(stage, scenes::walk, 2));
  WARN("largest displacement before the hitch " << usual_m * 1e3 << " mm, after it " << after_m * 1e3
                                                << " mm");
  CHECK(after_m < 2 * usual_m);
}

TEST_CASE("endless_dt_is_survived") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const FrameReport report = stage.world.step(std::numeric_limits<float>::infinity());
  CHECK(report.ticks == 8);
  CHECK(report.dropped_s > 9e5f);
  CHECK(test::all_finite(stage.read()));
}

TEST_CASE("ticks_follow_the_asset_s_own_rate") {
  const scenes::PackBytes slow = scenes::soft_block({.rate_hz = 30});
  Stage stage(1, {}, slow);
  uint32_t ticks = 0;
  for (int f = 0; f < 60; ++f) ticks += stage.step(scenes::walk, kFrame_s).ticks;
  CHECK(ticks == 30);
}

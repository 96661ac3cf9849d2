// test_time_scale.cpp  An instance whose time runs slower or faster than its world's.
#include <limits>

#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("a_time_scale_that_is_none_is_refused") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const std::vector<std::byte> before = stage.save();
  CHECK(stage.world.set_time_scale(stage.blocks[0], kNan).code == StatusCode::kNotFinite);
  for (const float bad : {-1.0f, 4.1f, INFINITY})
    CHECK(stage.world.set_time_scale(stage.blocks[0], bad).code == StatusCode::kInvalidArgument);
  CHECK(stage.world.set_time_scale({}, 1).code == StatusCode::kStaleId);
  CHECK(stage.save() == before);
}

TEST_CASE("half_speed_is_what_frames_of_half_the_length_are") {
  Stage slow, usual;
  REQUIRE(slow.world.set_time_scale(slow.blocks[0], 0.5f).ok());
  for (int f = 1; f <= 240; ++f) {
    const scenes::BlockPose pose = scenes::walk(f * kFrame_s / 2);
    slow.pose(slow.blocks[0], pose);
    usual.pose(usual.blocks[0], pose);
    slow.world.step(static_cast<float>(kFrame_s));
    usual.world.step(static_cast<float>(kFrame_s / 2));
    REQUIRE(slow.read() == usual.read());
  }
}

TEST_CASE("a_scale_of_its_own_changes_nothing_for_others") {
  Stage both(2), alone(1);
  REQUIRE(both.world.set_time_scale(both.blocks[1], 0.1f).ok());
  for (int f = 0; f < 120; ++f) {
    both.step(scenes::walk, kFrame_s);
    alone.step(scenes::walk, kFrame_s);
    REQUIRE(both.read(0) == alone.read(0));
  }
}

TEST_CASE("at_a_scale_of_0_flesh_is_held_and_goes_on_where_it_was") {
  Stage held, usual;
  held.play(scenes::walk, 1);
  usual.play(scenes::walk, 1);
  const std::vector<float> before = held.read();
  REQUIRE(held.world.set_time_scale(held.blocks[0], 0).ok());
  for (int f = 0; f < 40; ++f) {
    held.pose(held.blocks[0], scenes::walk(1));
    held.world.step(static_cast<float>(kFrame_s));
    REQUIRE(held.read() == before);
  }
  REQUIRE(held.world.set_time_scale(held.blocks[0], 1).ok());
  for (int f = 0; f < 60; ++f) {
    held.step(scenes::walk, kFrame_s);
    usual.step(scenes::walk, kFrame_s);
    REQUIRE(held.read() == usual.read());
  }
}

TEST_CASE("a_change_of_scale_moves_nothing_by_itself") {
  Stage stage;
  stage.play(scenes::walk, 2);
  double usual_m = 0, slow_m = 0, time_s = stage.time_s;
  std::vector<float> last = stage.read(0, Space::kBind);
  const auto moved_m = [&](double scale) {
    time_s += scale * kFrame_s;
    stage.pose(stage.blocks[0], scenes::walk(time_s));
    stage.world.step(static_cast<float>(kFrame_s));
    const std::vector<float> now = stage.read(0, Space::kBind);
    const double moved = test::largest_distance(now, last);
    last = now;
    return moved;
  };
  for (int f = 0; f < 60; ++f) usual_m = std::max(usual_m, moved_m(1));
  REQUIRE(stage.world.set_time_scale(stage.blocks[0], 0.1f).ok());
  for (int f = 0; f < 60; ++f) slow_m = std::max(slow_m, moved_m(0.1));
  // A tenth; what is shown between ticks is corrected at each of them.
  CHECK(slow_m < 0.5 * usual_m);
  REQUIRE(stage.world.set_time_scale(stage.blocks[0], 1).ok());
  for (int f = 0; f < 60; ++f) CHECK(moved_m(1) < 1.5 * usual_m);
}

TEST_CASE("a_snapshot_holds_the_scale_and_the_share_of_root_motion") {
  const auto played = [](Stage& stage) {
    std::vector<uint64_t> hashes;
    stage.time_s = 1;
    for (int f = 0; f < 40; ++f) {
      stage.step(scenes::walk, kFrame_s);
      hashes.push_back(test::hash_of(stage));
    }
    return hashes;
  };
  Stage stage;
  REQUIRE(stage.world.set_time_scale(stage.blocks[0], 0.3f).ok());
  REQUIRE(stage.world.set_felt_root_motion(stage.blocks[0], 0.4f).ok());
  stage.play(scenes::walk, 1);
  const std::vector<std::byte> saved = stage.save();
  const std::vector<uint64_t> first = played(stage);
  REQUIRE(stage.world.set_time_scale(stage.blocks[0], 2).ok());
  REQUIRE(stage.world.set_felt_root_motion(stage.blocks[0], 1).ok());
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  CHECK(played(stage) == first);
}

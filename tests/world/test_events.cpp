// test_events.cpp  What happened is told once, in order, and what nobody asks for is lost and counted.
#include <array>

#include "tests/world/poison.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

std::vector<Event> events_of(Stage& stage) {
  std::array<Event, 64> out;
  const size_t count = stage.world.take_events(out);
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count)};
}

scenes::BlockPose at_m(double x_m) { return scenes::bent_pose(0, x_m); }

}  // namespace

TEST_CASE("a_capacity_out_of_range_is_refused_and_a_null_world_has_no_events") {
  World world;
  CHECK(World::create({.event_capacity = 65536}, &world).code == StatusCode::kInvalidArgument);
  std::array<Event, 1> out;
  CHECK(world.take_events(out) == 0);
  CHECK(world.events_lost() == 0);
}

TEST_CASE("a_teleport_is_told_once_with_its_frame_and_instance") {
  Stage stage(2);
  stage.play([](double) { return at_m(0); }, 0.5);
  CHECK(events_of(stage).empty());
  stage.pose(stage.blocks[1], at_m(50));
  const uint64_t frame = stage.world.step(1.0f / 60).frame;
  const std::vector<Event> events = events_of(stage);
  REQUIRE(events.size() == 1);
  CHECK(events[0].kind == EventKind::kTeleport);
  CHECK(events[0].instance == stage.blocks[1]);
  CHECK(events[0].frame == frame);
  CHECK(events_of(stage).empty());
}

TEST_CASE("guards_that_fire_are_told") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  test::poison(stage, test::in_network(0.5));
  stage.step(scenes::walk, 1.0 / 60);
  std::vector<Event> events = events_of(stage);
  REQUIRE(!events.empty());
  CHECK(events.back().kind == EventKind::kNetworkGivenUp);
  test::poison(stage, [](const world::Instance& twin) { return twin.tissue.q[0]; });
  stage.step(scenes::walk, 1.0 / 60);
  events = events_of(stage);
  REQUIRE(!events.empty());
  CHECK(events.back().kind == EventKind::kRestart);
}

TEST_CASE("of_more_events_than_there_is_room_for_the_oldest_are_lost_and_counted") {
  Stage stage(1, {.event_capacity = 2});
  stage.play([](double) { return at_m(0); }, 0.5);
  for (int jump = 1; jump <= 3; ++jump) stage.play([&](double) { return at_m(20 * jump); }, 0.1);
  std::array<Event, 8> out;
  REQUIRE(stage.world.take_events(std::span(out).first(1)) == 1);
  CHECK(out[0].frame == 36);
  REQUIRE(stage.world.take_events(out) == 1);
  CHECK(out[0].frame == 42);
  CHECK(stage.world.events_lost() == 1);
}

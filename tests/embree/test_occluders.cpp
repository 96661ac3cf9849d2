// test_occluders.cpp  What hides characters: refusals, rays, moves, and a world that asks.
#include <cmath>
#include <limits>

#include "sinew/occluders.hpp"
#include "tests/embree/surface_scenes.hpp"
#include "tests/pack/count_allocations.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

using Place = double[3];

Occluders one_box(const Vector& half_m, OccluderId* id, const RootTransform& root = {},
                  const OccludersDef& def = {}) {
  Occluders occluders;
  REQUIRE(Occluders::create(def, &occluders).ok());
  const MeshData mesh = box(half_m);
  REQUIRE(occluders.add({.triangles = mesh.triangles, .places_m = mesh.places, .root = root}, id).ok());
  occluders.update();
  return occluders;
}

}  // namespace

TEST_CASE("what_is_no_occluder_is_refused_with_its_reason") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Occluders empty, occluders;
  OccluderId id;
  const MeshData mesh = box({1, 1, 1});
  const OccluderDef good{.triangles = mesh.triangles, .places_m = mesh.places};
  CHECK(empty.add(good, &id).code == StatusCode::kInvalidArgument);
  CHECK(empty.move(id, {}).code == StatusCode::kInvalidArgument);
  CHECK(empty.remove(id).code == StatusCode::kInvalidArgument);
  empty.update();
  CHECK_FALSE(empty.is_blocked({0, 0, 5}, {0, 0, -5}));
  CHECK(Occluders::create({}, nullptr).code == StatusCode::kInvalidArgument);
  CHECK(Occluders::create({.max_occluders = 0}, &occluders).code == StatusCode::kInvalidArgument);
  CHECK(Occluders::create({.origin_m = {0, std::nan(""), 0}}, &occluders).code == StatusCode::kNotFinite);
  REQUIRE(Occluders::create({.max_occluders = 1}, &occluders).ok());

  std::vector<OccluderDef> bad(6, good);
  const uint32_t missing[] = {0, 1, 8};
  const float nowhere[] = {0, 0, kNan};
  const uint32_t one[] = {0, 0, 0};
  bad[0].triangles = {};
  bad[1].triangles = bad[1].triangles.first(4);
  bad[2].triangles = missing;
  bad[3].places_m = {};
  bad[4].places_m = nowhere, bad[4].triangles = one;
  bad[5].root.rotation_xyzw[3] = 0;
  for (const OccluderDef& def : bad) {
    const Status status = occluders.add(def, &id);
    INFO(status.message);
    CHECK(status.code == StatusCode::kInvalidArgument);
    CHECK(id == OccluderId());
  }
  CHECK(occluders.add(good, nullptr).code == StatusCode::kInvalidArgument);
  REQUIRE(occluders.add(good, &id).ok());
  OccluderId second;
  CHECK(occluders.add(good, &second).code == StatusCode::kOutOfCapacity);
  REQUIRE(occluders.remove(id).ok());
  CHECK(occluders.remove(id).code == StatusCode::kStaleId);
  CHECK(occluders.move(id, {}).code == StatusCode::kStaleId);
}

TEST_CASE("what_stands_between_two_places_blocks_and_what_stands_beyond_does_not") {
  OccluderId id;
  Occluders occluders = one_box({1, 1, 0.1}, &id);
  const Place here = {0, 0, 5}, there = {0, 0, -5}, before = {0, 0, 1}, beside = {3, 0, -5},
              nowhere = {0, std::nan(""), 0};
  CHECK(occluders.is_blocked(here, there));
  CHECK(occluders.is_blocked(there, here));
  CHECK_FALSE(occluders.is_blocked(here, before));
  CHECK_FALSE(occluders.is_blocked(here, beside));
  CHECK_FALSE(occluders.is_blocked(here, here));
  CHECK_FALSE(occluders.is_blocked(here, nowhere));
}

TEST_CASE("a_moved_occluder_blocks_where_it_stands_and_nothing_blocks_before_the_update") {
  OccluderId id;
  const double far_m = 1e7;  // floats are a metre apart there
  Occluders occluders = one_box({1, 1, 0.1}, &id, {.position_m = {far_m, 0, 0}}, {.origin_m = {far_m, 0, 0}});
  const Place here = {far_m, 0, 5}, there = {far_m, 0, -5}, right = {far_m + 1.2, 0, 5},
              right_there = {far_m + 1.2, 0, -5};
  CHECK(occluders.is_blocked(here, there));
  CHECK_FALSE(occluders.is_blocked(right, right_there));
  REQUIRE(occluders.move(id, {.position_m = {far_m + 1.5, 0, 0}}).ok());
  CHECK_FALSE(occluders.is_blocked(right, right_there));
  occluders.update();
  CHECK_FALSE(occluders.is_blocked(here, there));
  CHECK(occluders.is_blocked(right, right_there));
  const auto quarter = static_cast<float>(std::sqrt(0.5));
  REQUIRE(occluders.move(id, {.position_m = {far_m, 0, 0}, .rotation_xyzw = {0, quarter, 0, quarter}}).ok());
  occluders.update();
  CHECK(occluders.is_blocked(here, there));
  CHECK_FALSE(occluders.is_blocked(right, right_there));  // now it is thin across
  REQUIRE(occluders.remove(id).ok());
  occluders.update();
  CHECK_FALSE(occluders.is_blocked(here, there));
}

TEST_CASE("a_character_behind_a_wall_is_hidden_and_steps_with_it_allocate_nothing") {
  OccluderId id;
  Occluders wall = one_box({2, 2, 0.1}, &id, {.position_m = {0, 0, 2}});
  Stage stage(1, {.occlusion = &wall});
  const View view{.position_m = {0, 0.3, 6}};
  REQUIRE(stage.world.set_views({&view, 1}).ok());
  stage.play(scenes::walk, 0.2);
  CHECK(stage.report().hidden);
  stage.pose(stage.blocks[0], scenes::walk(1));
  const size_t before = allocation_count();
  stage.world.step(1.0f / 60);
  CHECK(allocation_count() == before);
  REQUIRE(wall.move(id, {.position_m = {5, 0, 2}}).ok());
  wall.update();
  stage.play(scenes::walk, 0.1);
  CHECK_FALSE(stage.report().hidden);
}

// test_rod_scene.cpp  Random rods are rods that can be simulated.
#include "baker/rods/rod_scene.hpp"

#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"

using namespace sinew;
using Catch::Contains;

namespace {

const baker::RodRange kRanges[] = {{baker::RodKind::kBendingRod, 2, 40, 1e4, 1e9, 1},
                                   {baker::RodKind::kHelix, 10, 100, 1e4, 1e9, 1},
                                   {baker::RodKind::kTree, 6, 12, 1e6, 1e9, 20}};

double distance(const rods::SegmentPose& a, const rods::SegmentPose& b) {
  return std::hypot(a.position_m[0] - b.position_m[0], a.position_m[1] - b.position_m[1],
                    a.position_m[2] - b.position_m[2]);
}

}  // namespace

TEST_CASE("a_scene_that_does_not_exist_is_refused_with_those_that_do") {
  CHECK_THROWS_WITH(baker::rod_kind("knot", "here"),
                    Contains("here") && Contains("'knot'") && Contains("bending_rod, helix, tree"));
}

TEST_CASE("random_rods_are_strands_within_their_ranges") {
  for (const baker::RodRange& range : kRanges) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
      const baker::RodScene scene = baker::make_rod_scene(range, seed);
      const Status status = rods::check_strand({scene.segments}, 0);
      INFO(status.message);
      CHECK(status.ok());
      CHECK(scene.segments[0].fixed);
      const auto count = static_cast<double>(scene.segments.size());
      CHECK(count >= range.least_segments * range.rods);
      CHECK(count <= range.most_segments * range.rods);
      for (const rods::SegmentDef& s : scene.segments) {
        CHECK(static_cast<double>(s.young_modulus_pa) >= 0.999 * range.softest_pa);
        CHECK(static_cast<double>(s.young_modulus_pa) <= 1.001 * range.stiffest_pa);
      }
    }
  }
}

TEST_CASE("the_same_seed_gives_the_same_rod_and_another_seed_another") {
  const auto first = baker::make_rod_scene(kRanges[1], 5), again = baker::make_rod_scene(kRanges[1], 5),
             other = baker::make_rod_scene(kRanges[1], 6);
  REQUIRE(first.segments.size() == again.segments.size());
  for (size_t i = 0; i < first.segments.size(); ++i) {
    CHECK(first.segments[i].position_m[1] == again.segments[i].position_m[1]);
  }
  CHECK(first.segments[0].young_modulus_pa != other.segments[0].young_modulus_pa);
}

TEST_CASE("a_root_moves_from_where_it_is_at_rest_by_less_than_its_reach") {
  int moving = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    rods::SegmentDef root;
    root.position_m[0] = 7;
    const baker::RootMotion motion(root, 1, seed);
    const rods::SegmentPose start = motion.at(0);
    CHECK(start.position_m[0] == 7);
    double farthest = 0;
    for (double t = 0; t < 3; t += 0.01) farthest = std::max(farthest, distance(start, motion.at(t)));
    CHECK(farthest < 2);  // three waves of up to 0.3, from one side to the other
    moving += farthest > 0;
  }
  CHECK(moving > 8);  // of 40, half of which move
  CHECK(moving < 32);
}

// test_find_contacts.cpp  Which contacts a step has: along whole segments, side by side, swept, none at rest.
#include <array>
#include <random>

#include "tests/rods/passing_scenes.hpp"

using namespace sinew;

TEST_CASE("crossing_rods_touch_between_their_joints") {
  // 0.55 is the middle of a segment of the first, 0.5 of the second lies on a joint.
  test::RodBatch batch =
      test::batch_of({test::lying_rod(0), test::crossing_rod(0.55, 0.03)}, {.gravity_m_s2 = {0, 0, 0}});
  rods::RodCollider collider = test::collider_of(batch);
  test::throw_rod(batch, 1, 0, -1, 0);
  test::RodReport report;
  for (int i = 0; i < 6; ++i) report = test::step(batch, collider);
  CHECK(test::mean_velocity(batch, 0)[1] < -0.1);
  CHECK(report.contacts > 0);
  CHECK(report.deepest_penetration < 0.05f);
}

TEST_CASE("a_rod_at_rest_does_not_touch_itself_and_one_folded_by_force_does") {
  for (const double segment_m : {0.02, 0.005}) {  // the second overlaps its neighbours' neighbours
    test::RodBatch batch = test::batch_of({test::helix(30, segment_m)}, {.gravity_m_s2 = {0, 0, 0}});
    rods::RodCollider collider = test::collider_of(batch);
    for (int i = 0; i < 10; ++i) test::step(batch, collider);
    CHECK(rods::length(test::mean_velocity(batch, 0)) < 1e-6);
  }
  test::Segments rod = test::lying_rod(0, 40, 1e4f);
  rod.back().fixed = rod[0].fixed = true;
  test::RodBatch batch = test::batch_of({rod}, {.gravity_m_s2 = {0, 0, 0}});
  rods::RodCollider collider = test::collider_of(batch);
  // Its end is carried past its beginning, a third of a radius beside it, and then through there.
  uint32_t most = 0;
  for (int i = 0; i < 240; ++i) {
    rods::SegmentPose target = batch.pose(0, 39);
    const double angle = std::min(i, 120) * 3.14159265 / 120;
    target.position_m[0] = 0.5 + 0.4 * std::cos(angle);
    target.position_m[2] = 0.3 * std::sin(angle) + 0.003;
    REQUIRE(batch.set_target(0, 39, target).ok());
    most = std::max(most, test::step(batch, collider).contacts);
  }
  CHECK(most > 0);
}

TEST_CASE("rods_side_by_side_coincident_or_in_line_come_apart_and_stay_finite") {
  for (const double beside : {0.0, 1e-9, 0.015}) {
    for (const double along : {0.0, 0.05, 0.97}) {
      test::Segments second = test::lying_rod(beside);
      for (auto& s : second) s.position_m[0] += along;
      test::RodBatch batch = test::batch_of({test::lying_rod(0), second}, {.gravity_m_s2 = {0, 0, 0}});
      rods::RodCollider collider = test::collider_of(batch);
      test::RodReport report;
      for (int i = 0; i < 60; ++i) report = test::step(batch, collider);
      INFO("beside " << beside << ", along " << along);
      CHECK(report.recovered == 0);
      CHECK(report.deepest_penetration < 0.05f);
      for (const uint32_t strand : {0u, 1u}) {
        CHECK(rods::length(test::mean_velocity(batch, strand)) < 1);  // largest_push_out_m_s
      }
    }
  }
}

TEST_CASE("the_order_of_contacts_and_with_it_all_bits_are_the_same_in_a_second_run") {
  std::vector<double> first;
  for (const int run : {0, 1}) {
    std::mt19937 random(9);
    std::vector<test::Segments> strands;
    for (int i = 0; i < 18; ++i) {
      test::Segments rod =
          i % 2 ? test::crossing_rod(0.05 * i, 0.02 + 0.02 * i) : test::lying_rod(0.02 + 0.02 * i);
      for (auto& s : rod)
        s.position_m[2] += static_cast<double>(test::uniform(random, -0.2f, 0.2f)) * 0 + 0.01 * i;
      strands.push_back(rod);
    }
    test::RodBatch batch = test::batch_of(strands);
    rods::RodCollider collider = test::collider_of(batch);
    const rods::Plane floor;
    REQUIRE(collider.set_planes({&floor, 1}).ok());
    for (int i = 0; i < 40; ++i) test::step(batch, collider);
    for (uint32_t s = 0; s < 18; ++s) {
      const double x = batch.pose(s, 3).position_m[1];
      if (run == 0) first.push_back(x);
      CHECK(first[s] == x);
    }
  }
}

TEST_CASE("of_ten_thousand_rods_at_fifty_metres_a_second_none_passes_through_a_capsule_in_six_steps") {
  const auto through = GENERATE(test::Through::kObstacle, test::Through::kSource);
  const test::Passes passes = test::rods_at_a_bar(10000, through);
  CHECK(passes.passed == 0);
  CHECK(passes.hit > 9000);
}

TEST_CASE("of_ten_thousand_capsules_at_fifty_metres_a_second_none_passes_through_a_rod_in_six_steps") {
  const auto through = GENERATE(test::Through::kObstacle, test::Through::kSource);
  const test::Passes passes = test::bars_at_a_rod(10000, through);
  CHECK(passes.passed == 0);
  CHECK(passes.hit > 9000);
}

TEST_CASE("rods_that_meet_at_a_hundred_metres_a_second_do_not_pass_through_each_other") {
  int passed = 0;
  for (int run = 0; run < 200; ++run) {
    const double height = 0.1 + 0.007 * run;
    const test::Segments second = test::crossing_rod(0.45, height);
    test::RodBatch batch = test::batch_of({test::lying_rod(0), second}, {.gravity_m_s2 = {0, 0, 0}});
    rods::RodCollider collider = test::collider_of(batch);
    test::throw_rod(batch, 0, 0, 50, 0);
    test::throw_rod(batch, 1, 0, -50, 0);
    test::step(batch, collider);
    // Where they cross: the second's joint, the middle of the first's segment; both bend away from there.
    passed += test::end_of(batch, second, 4, 1)[1] < batch.pose(0, 4).position_m[1];
  }
  CHECK(passed == 0);
}

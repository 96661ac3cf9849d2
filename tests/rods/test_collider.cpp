// test_collider.cpp  What a collider refuses, how many contacts it holds, that a step allocates nothing, and
// that its bits do not depend on the processor.
#include <cstring>
#include <functional>
#include <string>

#include "tests/pack/count_allocations.hpp"
#include "tests/rods/recorded_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;

namespace {

struct BadSetting {
  const char* expected;
  std::function<void(rods::ColliderSettings&)> spoil;
};
const BadSetting kBad[] = {
    {"ColliderSettings::rod_friction is -1", [](auto& s) { s.rod_friction = -1; }},
    {"ColliderSettings::rod_friction is nan", [](auto& s) { s.rod_friction = std::nanf(""); }},
    {"ColliderSettings::tolerance is 0", [](auto& s) { s.tolerance = 0; }},
    {"ColliderSettings::tolerance is 2", [](auto& s) { s.tolerance = 2; }},
    {"ColliderSettings::largest_push_out_m_s is 0", [](auto& s) { s.largest_push_out_m_s = 0; }},
    {"ColliderSettings::largest_push_out_m_s is inf", [](auto& s) { s.largest_push_out_m_s = HUGE_VALF; }},
    {"ColliderSettings::contact_capacity is 1.67772e+07",
     [](auto& s) { s.contact_capacity = (1u << 24) + 1; }},
    {"ColliderSettings::obstacle_capacity is 65537", [](auto& s) { s.obstacle_capacity = 65537; }},
    {"ColliderSettings::point_capacity is 1.67772e+07", [](auto& s) { s.point_capacity = (1u << 24) + 1; }},
};

void check_says(const Status& status, const std::string& expected) {
  INFO(expected << " | " << status.message);
  CHECK_FALSE(status.ok());
  CHECK(std::string(status.message).find(expected) != std::string::npos);
}

}  // namespace

TEST_CASE("a_collider_refuses_bad_settings_obstacles_and_batches_and_stays_as_it_was") {
  test::RodBatch batch = test::batch_of({test::lying_rod(0.05)});
  rods::RodCollider collider = test::collider_of(batch, {.obstacle_capacity = 2, .point_capacity = 1});
  const rods::Plane floor, mirror = {.normal = {0, 1, 0.1f}};
  REQUIRE(collider.set_planes({&floor, 1}).ok());
  for (const BadSetting& bad : kBad) {
    rods::ColliderSettings settings;
    bad.spoil(settings);
    check_says(rods::RodCollider::create(batch, settings, &collider), bad.expected);
  }
  check_says(rods::RodCollider::create({}, {}, &collider), "no strand");
  const rods::Plane planes[3] = {floor, mirror, floor};
  check_says(collider.set_planes({planes, 2}), "plane 1: the length of normal is 1.00499");
  check_says(collider.set_planes(planes), "3 planes where the collider has room for 2");
  const rods::Sphere spheres[2] = {{.radius_m = 1}, {.middle_m = {0, std::nan(""), 0}, .radius_m = 1}};
  check_says(collider.set_spheres(spheres), "sphere 1: middle_m is nan");
  const rods::Capsule capsule = {.radius_m = -1};
  check_says(collider.set_capsules({&capsule, 1}), "capsule 0: radius_m is -1");
  const rods::ContactPoint elsewhere = {.segment = 10}, nobody = {.strand = 1}, bad = {.along = 3};
  check_says(collider.set_points({&elsewhere, 1}), "contact point 0: strand 0, segment 10 where the batch");
  check_says(collider.set_points({&nobody, 1}), "contact point 0: strand 1, segment 0 where the batch");
  check_says(collider.set_points({&bad, 1}), "contact point 0: along is 3");
  test::RodBatch other = test::batch_of({test::lying_rod(0.05, 5)});
  check_says(other.step(test::kFrame_s, &collider, nullptr), "the collider is for 1 strands of 10 segments");
  check_says(batch.step(-1, &collider, nullptr), "dt_s is -1");
  for (int i = 0; i < 60; ++i) test::step(batch, collider);
  CHECK(batch.pose(0, 4).position_m[1] == Approx(0.01).margin(0.0005));  // the first floor still holds it
}

TEST_CASE("contacts_beyond_the_capacity_are_dropped_and_counted_and_the_first_stay") {
  test::RodBatch batch = test::batch_of({test::lying_rod(0.0101)});
  rods::RodCollider roomy = test::collider_of(batch),
                    small = test::collider_of(batch, {.contact_capacity = 4});
  const rods::Plane floor;
  REQUIRE((roomy.set_planes({&floor, 1}).ok() && small.set_planes({&floor, 1}).ok()));
  test::RodReport report = test::step(batch, roomy);
  CHECK(report.contacts == 11);  // ten ends and a beginning
  CHECK(report.contacts_dropped == 0);
  for (int i = 0; i < 3; ++i) report = test::step(batch, small);
  CHECK(report.contacts == 4);
  CHECK(report.contacts_dropped == 7);
  CHECK(batch.pose(0, 0).position_m[1] == Approx(0.01).margin(0.001));
  CHECK(batch.pose(0, 9).position_m[1] < 0.008);  // falls through
}

TEST_CASE("a_step_with_contacts_allocates_nothing") {
  std::vector<test::Segments> strands;
  for (int i = 0; i < 20; ++i) strands.push_back(test::lying_rod(0.01 + 0.019 * i));
  test::RodBatch batch = test::batch_of(strands);
  rods::RodCollider collider = test::collider_of(batch);
  const rods::Plane floor;
  const rods::Sphere ball = {.middle_m = {0.5, 0.1, 0.1}, .radius_m = 0.1f};
  REQUIRE((collider.set_planes({&floor, 1}).ok() && collider.set_spheres({&ball, 1}).ok()));
  CHECK(test::step(batch, collider).contacts > 100);
  const size_t before = test::allocation_count();
  for (int i = 0; i < 10; ++i) (void)batch.step(test::kFrame_s, &collider, nullptr);
  CHECK(test::allocation_count() == before);
}

TEST_CASE("contacts_have_the_same_bits_on_all_targets_with_fma_in_narrow_groups_and_wide") {
  test::require_same_bits_where_fused(0xc47246eab3a71ff2, [](const simd::Kernels&) {
    std::vector<float> out;
    test::append_fallen({}, &out);
    return out;
  });
}

TEST_CASE("a_collider_that_is_empty_or_far_away_changes_no_bit") {
  const rods::Plane floor = {.point_m = {0, -100, 0}};
  for (const bool rods_collide : {false, true}) {
    for (const bool with_floor : {false, true}) {
      for (const size_t count : {1u, 4u, 19u}) {
        std::vector<test::Segments> strands(count, test::helix(11, 0.05, 1e5f));
        for (size_t i = 0; i < count; ++i) {
          for (auto& s : strands[i]) s.position_m[0] += 5.0 * static_cast<double>(i);
        }
        test::RodBatch alone = test::batch_of(strands), batch = test::batch_of(strands);
        rods::RodCollider collider = test::collider_of(batch, {.rods_collide = rods_collide});
        if (with_floor) REQUIRE(collider.set_planes({&floor, 1}).ok());
        for (int i = 0; i < 60; ++i) {
          CHECK(test::step(batch, collider).contacts == 0);
          test::step(alone, test::kFrame_s);
        }
        std::vector<float> expected, found;
        test::append_states(alone, &expected);
        test::append_states(batch, &found);
        INFO(count << " strands");
        CHECK(expected.size() == found.size());
        CHECK(std::memcmp(expected.data(), found.data(), expected.size() * sizeof(float)) == 0);
      }
    }
  }
}

TEST_CASE("a_segment_goes_through_the_capsules_that_it_passes_and_no_other_does") {
  test::RodBatch batch = test::batch_of({test::lying_rod(0.1), test::lying_rod(0.1)});
  rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false});
  CHECK(collider.set_passed(2, 0, 1).code == StatusCode::kInvalidArgument);
  CHECK(collider.set_passed(0, 10, 1).code == StatusCode::kInvalidArgument);
  for (uint32_t i = 0; i < batch.segment_count(); ++i) REQUIRE(collider.set_passed(0, i, 2).ok());
  const rods::Capsule far = {.ends_m = {{9, 0, 0}, {9, 1, 0}}, .radius_m = 0.05f};
  const rods::Capsule bar = {.ends_m = {{-1, 0, 0}, {2, 0, 0}}, .radius_m = 0.05f};
  const rods::Capsule both[] = {far, bar};
  REQUIRE(collider.set_capsules(both).ok());
  for (int i = 0; i < 30; ++i) test::step(batch, collider);
  CHECK(batch.pose(0, 5).position_m[1] < -0.5);  // fell half a second
  CHECK(batch.pose(1, 5).position_m[1] > 0.05);
}

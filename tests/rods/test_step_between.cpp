// test_step_between.cpp  Rods between two steps: at the end the step's own, and one velocity through it.
#include <catch2/catch.hpp>

#include "rods/contacts/collider.hpp"
#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

constexpr float kStep_s = 1.0f / 60;

using Turns = std::vector<float>;

Turns between(const test::RodBatch& batch, float fraction, const rods::RodCollider* touched = nullptr) {
  Turns turns(size_t{4} * batch.strand_count() * batch.segment_count());
  REQUIRE(batch.step_between(kStep_s, fraction, touched, turns.data()).ok());
  return turns;
}

Turns turns_of(const test::RodBatch& batch) {
  Turns turns;
  for (uint32_t i = 0; i < batch.segment_count(); ++i) {
    const rods::SegmentPose pose = batch.pose(0, i);
    turns.insert(turns.end(), pose.orientation, pose.orientation + 4);
  }
  return turns;
}

double largest(const Turns& a, const Turns& b, double scale = 1) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, scale * std::abs(double{a[i]} - double{b[i]}));
  return most;
}

// The held end moves to and fro.
void hold(test::RodBatch& batch, double time_s) {
  rods::SegmentPose pose = batch.pose(0, 0);
  pose.position_m[1] = 0.05 * std::sin(9 * time_s);
  REQUIRE(batch.set_target(0, 0, pose).ok());
}

test::RodBatch hanging(float damping_s = 0) {
  test::Segments rod =
      test::straight_rod({.segments = 12, .young_pa = 3e6f, .length_m = 0.6, .radius_m = 0.01f});
  for (test::SegmentDef& segment : rod) segment.damping_s = damping_s;
  return test::batch_of({rod}, {.start = rods::RodStart::kContinued, .tolerance_rad = 1e-5f});
}

}  // namespace

TEST_CASE("a_fraction_outside_a_step_is_refused") {
  const test::RodBatch batch = hanging();
  Turns turns(size_t{4} * batch.segment_count());
  for (const float bad : {0.0f, -0.5f, 1.01f, NAN}) {
    CHECK(batch.step_between(kStep_s, bad, nullptr, turns.data()).code == StatusCode::kInvalidArgument);
    CHECK(batch.step_between(bad, 0.5f, nullptr, turns.data()).code == StatusCode::kInvalidArgument);
  }
}

TEST_CASE("a_fraction_changes_nothing_of_the_steps_that_follow") {
  test::RodBatch batch = hanging(), other = hanging();
  for (int step = 0; step < 60; ++step) {
    hold(batch, (step + 0.4) * static_cast<double>(kStep_s));
    between(batch, 0.4f);
    for (test::RodBatch* each : {&batch, &other}) {
      hold(*each, (step + 1) * static_cast<double>(kStep_s));
      test::step(*each, kStep_s);
    }
    CHECK(turns_of(batch) == turns_of(other));
  }
}

// Both iterations end within their tolerance.
TEST_CASE("a_whole_fraction_is_the_step") {
  test::RodBatch batch = hanging();
  for (int step = 0; step < 60; ++step) {
    hold(batch, (step + 1) * static_cast<double>(kStep_s));
    const Turns whole = between(batch, 1);
    test::step(batch, kStep_s);
    CHECK(largest(whole, turns_of(batch)) < 3e-5);
  }
}

TEST_CASE("velocity_goes_on_through_steps") {
  constexpr float kShort = 0.05f;
  for (const float damping_s : {0.0f, 0.05f}) {
    test::RodBatch batch = hanging(damping_s);
    double jump = 0, fastest = 0;
    for (int step = 0; step < 120; ++step) {
      const auto at = [&](double fraction) {
        hold(batch, (step + fraction) * static_cast<double>(kStep_s));
        return between(batch, static_cast<float>(fraction));
      };
      const Turns a = at(1 - static_cast<double>(kShort)), b = at(1);
      test::step(batch, kStep_s);
      const Turns now = turns_of(batch);
      hold(batch, (step + 1 + static_cast<double>(kShort)) * static_cast<double>(kStep_s));
      const Turns c = between(batch, kShort);
      if (step < 30) continue;
      Turns before(a.size()), after(a.size());
      for (size_t i = 0; i < a.size(); ++i) before[i] = b[i] - a[i], after[i] = c[i] - now[i];
      jump = std::max(jump, largest(before, after, 1 / double{kShort}));
      fastest = std::max(fastest, largest(before, Turns(before.size()), 1 / double{kShort}));
    }
    INFO("velocity jumps by " << jump << " of " << fastest << " a step");
    CHECK(jump < 0.12 * fastest);  // accelerations change within a step; Euler's own fraction leaves 0.4
  }
}

// A rod that lies on a plane does not fall through it between two steps.
TEST_CASE("what_touched_in_the_last_step_holds_in_its_fraction") {
  test::RodBatch batch = hanging();
  rods::RodCollider collider;
  REQUIRE(rods::RodCollider::create(batch, {}, &collider).ok());
  const rods::Plane floor{.point_m = {0, -0.05, 0}};
  REQUIRE(collider.set_planes({&floor, 1}).ok());
  for (int step = 0; step < 600; ++step) REQUIRE(batch.step(kStep_s, &collider, nullptr).ok());
  REQUIRE(collider.has_forces());
  const Turns rests = turns_of(batch);
  for (const float fraction : {0.25f, 0.5f, 0.75f}) {
    const double held = largest(between(batch, fraction, &collider), rests),
                 free = largest(between(batch, fraction), rests);
    CHECK(free > 1e-3);
    CHECK(held < 0.1 * free);
  }
}

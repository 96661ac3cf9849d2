// test_take_state.cpp  A batch that takes another's state goes on as that one does.
#include <catch2/catch.hpp>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

void check_refused(test::RodBatch& batch, const test::RodBatch& other) {
  const rods::SegmentPose before = batch.pose(0, 2);
  const Status status = batch.take_state(other);
  CHECK(status.code == StatusCode::kInvalidArgument);
  CHECK_THAT(status.message, Catch::Contains("made of the same strands"));
  CHECK(test::distance(batch.pose(0, 2).position_m, before.position_m) == 0);
}

// 3 strands that differ, moved, pushed and held elsewhere.
std::vector<test::Segments> strands() {
  return {test::helix(12), test::helix(12, 0.03), test::helix(12, 0.02, 1e5f)};
}
void disturb(test::RodBatch& batch) {
  for (int i = 0; i < 25; ++i) test::step(batch, 1.0f / 60);
  rods::SegmentPose target = batch.pose(1, 0);
  target.position_m[0] += 0.004;
  REQUIRE(batch.set_target(1, 0, target).ok());
  REQUIRE(batch.set_force(2, 7, {0.001f, 0, 0.002f}).ok());
}

double apart(const test::RodBatch& a, const test::RodBatch& b) {
  double largest = 0;
  for (uint32_t s = 0; s < a.strand_count(); ++s) {
    for (uint32_t i = 0; i < a.segment_count(); ++i) {
      largest = std::max(largest, test::distance(a.pose(s, i).position_m, b.pose(s, i).position_m));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("a_state_is_taken_only_from_a_batch_of_the_same_strands") {
  test::RodBatch batch = test::batch_of({test::helix(12)});
  check_refused(batch, test::batch_of({test::helix(11)}));
  check_refused(batch, test::batch_of({test::helix(12), test::helix(12)}));
  test::Segments forked = test::helix(12);
  forked[11].parent = 9;
  for (int k = 0; k < 3; ++k) forked[11].position_m[k] = forked[10].position_m[k];
  std::copy_n(forked[10].orientation, 4, forked[11].orientation);
  check_refused(batch, test::batch_of({forked}));
  test::Segments held_at_its_tip = test::helix(12);
  held_at_its_tip[0].fixed = false;
  held_at_its_tip[11].fixed = true;
  check_refused(batch, test::batch_of({held_at_its_tip}));
  check_refused(batch, test::RodBatch());
}

TEST_CASE("two_batches_with_one_state_take_the_same_steps") {
  test::RodBatch from = test::batch_of(strands()), to = test::batch_of(strands());
  disturb(from);
  CHECK(apart(from, to) > 0.01);
  REQUIRE(to.take_state(from).ok());
  for (int i = 0; i < 20; ++i) {
    CHECK(apart(from, to) == 0);  // the same floats through the same operations
    test::step(from, 1.0f / 60);
    test::step(to, 1.0f / 60);
  }
}

TEST_CASE("what_a_start_remembers_comes_along_and_begins_anew_from_a_batch_that_remembers_nothing") {
  const rods::RodSettings continued = {.start = rods::RodStart::kContinued};
  test::RodBatch from = test::batch_of(strands(), continued), to = test::batch_of(strands(), continued);
  disturb(from);
  REQUIRE(to.take_state(from).ok());
  for (int i = 0; i < 10; ++i) {
    test::step(from, 1.0f / 60);
    test::step(to, 1.0f / 60);
    CHECK(apart(from, to) == 0);  // the same floats through the same operations
  }
  test::RodBatch plain = test::batch_of(strands());
  disturb(plain);
  REQUIRE(to.take_state(plain).ok());
  // Two steps know too little to be continued: both batches start from the last one.
  for (int i = 0; i < 2; ++i) {
    test::step(plain, 1.0f / 60);
    test::step(to, 1.0f / 60);
    CHECK(apart(plain, to) == 0);
  }
}

TEST_CASE("settings_are_not_taken_with_a_state") {
  test::RodBatch from = test::batch_of(strands());
  test::RodBatch to = test::batch_of(strands(), {.start = rods::RodStart::kZero, .max_iterations = 1});
  disturb(from);
  REQUIRE(to.take_state(from).ok());
  CHECK(test::step(to, 1.0f / 60).iterations == 1);
  CHECK(test::step(from, 1.0f / 60).iterations > 1);
}

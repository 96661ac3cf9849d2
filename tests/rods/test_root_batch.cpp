// test_root_batch.cpp  How a rod is listed does not matter.
#include <catch2/catch.hpp>

#include "rods/create/batch_builder.hpp"
#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

// The same rod told from its other end: a segment's z points the other way, half a turn about its own x.
test::Segments listed_backwards(const test::Segments& rod) {
  test::Segments out(rod.rbegin(), rod.rend());
  for (uint32_t i = 0; i < out.size(); ++i) {
    const rods::Turn q = rods::product(rods::turn_of(out[i].orientation), {1, 0, 0, 0});
    for (size_t k = 0; k < 4; ++k) out[i].orientation[k] = static_cast<float>(q[k]);
    out[i].parent = i == 0 ? rods::kNoParent : i - 1;
    if (i == 0) continue;
    const test::SegmentDef& joint = rod[rod.size() - i];  // that was the child
    out[i].young_modulus_pa = joint.young_modulus_pa;
    out[i].torsion_modulus_pa = joint.torsion_modulus_pa;
    out[i].stretch_modulus_pa = joint.stretch_modulus_pa;
    out[i].damping_s = joint.damping_s;
  }
  return out;
}

struct Difference {
  double place = 0, axis = 0, force = 0;  // over a segment's length, in radians, over the largest force
  uint32_t unconverged = 0;
};

Difference difference_of_listings(const test::Segments& rod, int steps, test::RodSettings settings = {}) {
  test::RodBatch one = test::batch_of({rod}, settings);
  test::RodBatch other = test::batch_of({listed_backwards(rod)}, settings);
  Difference out;
  for (int i = 0; i < steps; ++i) {
    out.unconverged += test::step(one, 0.02f).unconverged + test::step(other, 0.02f).unconverged;
  }
  double largest_force = 0;
  for (uint32_t i = 0; i < rod.size(); ++i) {
    const auto last = static_cast<uint32_t>(rod.size()) - 1;
    const rods::SegmentPose a = one.pose(0, i), b = other.pose(0, last - i);
    out.place = std::max(out.place,
                         test::distance(a.position_m, b.position_m) / static_cast<double>(rod[i].length_m));
    const rods::Vector z = test::axis_of(b);
    out.axis = std::max(out.axis, test::distance(test::axis_of(a), {-z[0], -z[1], -z[2]}));
    if (i == 0) continue;
    const rods::Vector f = rods::vector_of(one.last_forces(0, i).force_n),
                       g = rods::vector_of(other.last_forces(0, last - i + 1).force_n);
    out.force = std::max(out.force, test::distance(f, {-g[0], -g[1], -g[2]}));
    largest_force = std::max(largest_force, std::hypot(f[0], f[1], f[2]));
  }
  out.force /= largest_force;
  return out;
}

void check_alike(const Difference& d) {
  // Single precision over as many steps; what is listed backwards is rounded elsewhere.
  CHECK(d.place < 1e-3);
  CHECK(d.axis < 1e-3);
  CHECK(d.force < 0.02);  // a stiff rod's forces answer to the last digit of its orientations
  CHECK(d.unconverged == 0);
}

}  // namespace

TEST_CASE("a_rod_listed_from_either_end_is_the_same_rod") {
  for (const float young : {1e4f, 1e6f, 1e8f, 1e10f}) {
    INFO("Young's modulus " << young);
    check_alike(difference_of_listings(test::straight_rod({.segments = 30, .young_pa = young}), 30));
    test::Segments rod = test::helix(24, 0.1, young);
    for (uint32_t i = 1; i < 24; ++i) {
      rod[i].young_modulus_pa *= 1 + 0.05f * static_cast<float>(i);
      rod[i].damping_s = 0.01f;
    }
    check_alike(difference_of_listings(rod, 30));
    rod[0].fixed = false;
    rod[17].fixed = true;
    check_alike(difference_of_listings(rod, 30));
  }
}

TEST_CASE("a_rod_listed_from_its_free_end_costs_no_more_iterations") {
  const auto iterations = [](const test::Segments& rod) {
    test::RodBatch batch = test::batch_of({rod});
    uint32_t sum = 0;
    for (int i = 0; i < 100; ++i) sum += test::step(batch, 0.02f).iterations_sum;
    return sum;
  };
  const test::Segments rod = test::straight_rod({.segments = 50, .young_pa = 1e8f, .torsion_pa = 1e8f});
  CHECK(iterations(listed_backwards(rod)) <= iterations(rod) + 2);  // rounding decides at the tolerance
}

TEST_CASE("a_start_given_to_a_rod_listed_from_its_free_end_is_its_own") {
  // What a converged step ended with, given to a twin in the same state, leaves one iteration to do.
  const test::Segments rod = listed_backwards(test::helix(20, 0.1, 1e6f));
  test::RodBatch batch = test::batch_of({rod}, {.start = rods::RodStart::kZero, .tolerance_rad = 1e-4f});
  test::RodBatch twin = test::batch_of({rod}, {.start = rods::RodStart::kGiven, .tolerance_rad = 1e-4f});
  for (int i = 0; i < 20; ++i) {
    const uint32_t from_zero = test::step(batch, 0.02f).iterations;
    for (uint32_t k = 0; k < 20; ++k) REQUIRE(twin.set_start(0, k, batch.last_forces(0, k)).ok());
    CHECK(test::step(twin, 0.02f).iterations == 1);
    CHECK(from_zero > 1);
  }
}

TEST_CASE("the_segment_that_most_strands_hold_ends_the_elimination") {
  test::Segments rod = test::helix(5), other = rod;
  rod[0].fixed = other[0].fixed = false;
  const auto held = [&] {
    const rods::StrandDef strands[] = {{rod}, {other}};
    return rods::most_held(strands);
  };
  CHECK(held() == 0);
  rod[3].fixed = true;
  CHECK(held() == 3);
  rod[1].fixed = other[1].fixed = true;
  CHECK(held() == 1);
  other[3].fixed = true;
  CHECK(held() == 1);
}

TEST_CASE("strands_of_one_batch_may_be_held_at_different_ends") {
  test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e8f}), other = rod;
  other[0].fixed = false;
  other[19].fixed = true;
  test::RodBatch both = test::batch_of({rod, other}, {.max_iterations = 50}), alone = test::batch_of({other});
  for (int i = 0; i < 50; ++i) {
    CHECK(test::step(both, 0.02f).unconverged == 0);
    test::step(alone, 0.02f);
  }
  for (uint32_t i = 0; i < 20; ++i) {
    // The second is held at the end of the elimination in one batch and at its beginning in the other.
    CHECK(test::distance(both.pose(1, i).position_m, alone.pose(0, i).position_m) < 2e-3);
  }
}

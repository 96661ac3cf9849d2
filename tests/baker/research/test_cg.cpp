// test_cg.cpp  Conjugate gradients reach what the direct solver reaches.
#include <catch2/catch.hpp>

#include "baker/research/rods/compared_solver.hpp"
#include "tests/rods/contact_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;

namespace {

constexpr float kDt_s = 0.02f;

baker::ComparedSolver cg_solver(float tolerance = 1e-4f) {
  return {.kind = baker::SolverKind::kCg, .cg = {.tolerance = tolerance}};
}

test::RodBatch batch_by(rods::RodSolver solver, const std::vector<test::Segments>& strands) {
  return test::batch_of(strands, {.solver = solver, .max_iterations = 100, .tolerance_rad = 1e-4f});
}

// Of a segment's length after some steps; single precision through two different orders of sums.
double largest_difference(const test::Segments& segments, int steps = 50) {
  baker::ComparedSolver solver = cg_solver(1e-5f);
  test::RodBatch direct = batch_by({}, {segments}), cg = batch_by(solver.solver(), {segments});
  double largest = 0;
  for (int i = 0; i < steps; ++i) {
    test::step(direct, kDt_s);
    const uint32_t before = solver.cg_iterations;
    REQUIRE(test::step(cg, kDt_s).unconverged == 0);
    REQUIRE(solver.cg_iterations > before);
  }
  for (uint32_t i = 0; i < segments.size(); ++i) {
    largest = std::max(largest, test::distance(direct.pose(0, i).position_m, cg.pose(0, i).position_m) /
                                    static_cast<double>(segments[i].length_m));
  }
  return largest;
}

}  // namespace

TEST_CASE("cg_takes_the_steps_that_direct_takes_on_every_target") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    CHECK(largest_difference(test::straight_rod({.segments = 10, .young_pa = 1e5f})) < 1e-3);
    CHECK(largest_difference(test::helix(12, 0.1, 1e5f)) < 1e-3);
    // Bends a hundred times more stiffly than it twists.
    CHECK(largest_difference(test::straight_rod({.segments = 10, .young_pa = 1e8f}), 20) < 1e-3);
  });
}

TEST_CASE("cg_takes_the_steps_that_direct_takes_where_rods_branch_or_are_held_twice") {
  test::Segments rod = test::helix(12, 0.1, 1e5f);
  test::SegmentDef twig = rod[6];  // beside its twin, lighter
  twig.density_kg_m3 = 300;
  rod.push_back(twig);
  CHECK(largest_difference(rod) < 1e-3);
  rod[10].fixed = rod[11].fixed = true;
  CHECK(largest_difference(rod, 10) < 1e-3);
}

TEST_CASE("a_strand_in_cg_does_not_know_of_its_neighbours") {
  const test::Segments soft = test::helix(8, 0.1, 1e3f), stiff = test::helix(8, 0.1, 1e7f);
  baker::ComparedSolver solver = cg_solver(1e-5f);
  test::RodBatch both = batch_by(solver.solver(), {soft, stiff}), alone = batch_by(solver.solver(), {soft});
  for (int i = 0; i < 20; ++i) {
    test::step(both, kDt_s);
    test::step(alone, kDt_s);
  }
  for (uint32_t i = 0; i < 8; ++i) {
    CHECK(test::distance(both.pose(0, i).position_m, alone.pose(0, i).position_m) == 0);
  }
}

TEST_CASE("cg_needs_more_iterations_for_longer_rods") {
  const auto iterations = [](uint32_t segments) {
    baker::ComparedSolver solver = cg_solver(1e-5f);
    test::RodBatch batch =
        batch_by(solver.solver(), {test::straight_rod({.segments = segments, .young_pa = 1e6f})});
    for (int i = 0; i < 10; ++i) test::step(batch, kDt_s);
    return solver.cg_iterations;
  };
  CHECK(iterations(30) > 2 * iterations(10));
}

TEST_CASE("cg_ends_by_what_free_motion_leaves_not_by_its_start") {
  const test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e6f});
  test::RodSettings settings;
  settings.start = rods::RodStart::kZero;
  settings.max_iterations = 100;
  settings.tolerance_rad = 1e-5f;
  test::RodBatch truth = test::batch_of({rod}, settings);
  settings = {};
  baker::ComparedSolver with_truth = cg_solver(), with_nothing = cg_solver();
  settings.solver = with_truth.solver();
  settings.start = rods::RodStart::kGiven;
  test::RodBatch told = test::batch_of({rod}, settings);
  settings.solver = with_nothing.solver();
  settings.start = rods::RodStart::kZero;
  test::RodBatch zero = test::batch_of({rod}, settings);
  for (int i = 0; i < 20; ++i) {
    test::step(truth, kDt_s);
    for (uint32_t k = 0; k < rod.size(); ++k) REQUIRE(told.set_start(0, k, truth.last_forces(0, k)).ok());
    test::step(told, kDt_s);
    test::step(zero, kDt_s);
  }
  // Some 50 a step; float's own noise may ask for one now and then.
  CHECK(with_nothing.cg_iterations > 20 * 40);
  CHECK(with_truth.cg_iterations <= 20 * 2);
  for (uint32_t k = 0; k < rod.size(); ++k) {
    CHECK(test::distance(truth.pose(0, k).position_m, told.pose(0, k).position_m) < 1e-3);
  }
}

TEST_CASE("cg_ends_where_free_motion_misses_nothing") {
  test::RodSettings settings;
  baker::ComparedSolver solver = cg_solver();
  settings.solver = solver.solver();
  settings.gravity_m_s2[1] = 0;
  test::RodBatch batch = test::batch_of({test::straight_rod({.segments = 10})}, settings);
  for (int i = 0; i < 3; ++i) test::step(batch, kDt_s);
  CHECK(solver.cg_iterations < 300);
}

TEST_CASE("cg_needs_fewer_iterations_from_the_last_step_and_fewer_still_where_it_is_continued") {
  const auto iterations = [](rods::RodStart start) {
    baker::ComparedSolver solver = cg_solver();
    test::RodBatch batch =
        test::batch_of({test::straight_rod({.segments = 20, .young_pa = 1e5f})},
                       {.solver = solver.solver(), .start = start, .tolerance_rad = 1e-3f});
    for (int i = 0; i < 100; ++i) test::step(batch, kDt_s);
    return solver.cg_iterations;
  };
  const double previous = iterations(rods::RodStart::kPrevious);
  CHECK(previous < 0.9 * iterations(rods::RodStart::kZero));
  CHECK(iterations(rods::RodStart::kContinued) < 0.9 * previous);
}

// Down a plane that is steeper than friction holds, for a second.
TEST_CASE("cg_slides_as_direct_slides") {
  const auto speed = [](rods::RodSolver solver) {
    test::RodBatch batch =
        test::batch_of({test::lying_rod(0.01)}, {.solver = solver, .gravity_m_s2 = {6.13f, -7.66f, 0}});
    rods::RodCollider collider = test::collider_of(batch);
    const rods::Plane floor = {.friction = 0.5f};
    REQUIRE(collider.set_planes({&floor, 1}).ok());
    for (int i = 0; i < 60; ++i) test::step(batch, collider);
    return test::mean_velocity(batch, 0)[0];
  };
  baker::ComparedSolver solver = cg_solver();
  const double direct = speed({});
  CHECK(direct > 2);
  CHECK(speed(solver.solver()) == Approx(direct).margin(0.02));
}

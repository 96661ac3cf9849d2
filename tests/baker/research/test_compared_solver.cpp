// test_compared_solver.cpp  What all solvers have in common: recorded bits, a bounded reach, what few
// iterations leave.
#include "baker/research/rods/compared_solver.hpp"

#include "baker/common/bad_input.hpp"
#include "tests/rods/recorded_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using baker::SolverKind;

TEST_CASE("numbers_outside_their_range_make_no_solver") {
  const baker::ComparedSolver bad[] = {{.cg = {.tolerance = 0}},      {.cg = {.tolerance = std::nanf("")}},
                                       {.cg = {.max_iterations = 0}}, {.cg = {.max_iterations = 100001}},
                                       {.local_sweeps = 0},           {.local_sweeps = 10001}};
  for (baker::ComparedSolver solver : bad) CHECK_THROWS_AS(solver.solver(), baker::BadInput);
}

TEST_CASE("the_local_solver_is_refused_with_a_collider_and_nothing_moves") {
  baker::ComparedSolver solver = {.kind = SolverKind::kLocal};
  test::RodBatch batch = test::batch_of({test::straight_rod({.segments = 4})}, {.solver = solver.solver()});
  rods::RodCollider collider = test::collider_of(batch, {});
  const rods::SegmentPose before = batch.pose(0, 3);
  rods::RodReport report;
  const Status status = batch.step(0.02f, &collider, &report);
  CHECK(status.code == StatusCode::kInvalidArgument);
  CHECK_THAT(status.message, Catch::Contains("knows no contacts"));
  CHECK(test::distance(before.position_m, batch.pose(0, 3).position_m) == 0);
}

TEST_CASE("rods_have_the_same_bits_on_all_targets_with_fma_by_every_solver_in_narrow_groups_and_wide") {
  test::require_same_bits_where_fused(0x5ad359be847c9619, [](const simd::Kernels&) {
    std::vector<float> out;
    for (const SolverKind kind : {SolverKind::kDirect, SolverKind::kCg, SolverKind::kLocal}) {
      baker::ComparedSolver solver = {.kind = kind};
      test::append_bent({.solver = solver.solver()}, &out);
    }
    return out;
  });
}

TEST_CASE("contacts_have_the_same_bits_on_all_targets_with_fma_by_both_solvers_in_narrow_groups_and_wide") {
  test::require_same_bits_where_fused(0x9cdf64be3157c977, [](const simd::Kernels&) {
    std::vector<float> out;
    for (const SolverKind kind : {SolverKind::kDirect, SolverKind::kCg}) {
      baker::ComparedSolver solver = {.kind = kind};
      test::append_fallen({.solver = solver.solver()}, &out);
    }
    return out;
  });
}

TEST_CASE("whatever_a_solver_leaves_undone_a_rod_stays_within_reach_of_where_it_is_held") {
  for (const SolverKind kind : {SolverKind::kCg, SolverKind::kLocal}) {
    for (const uint32_t count : {30u, 200u}) {
      for (const float young : {1e4f, 1e9f}) {
        const test::Segments rod = test::straight_rod({.segments = count, .young_pa = young});
        baker::ComparedSolver solver = {.kind = kind, .cg = {.max_iterations = 5}, .local_sweeps = 1};
        test::RodBatch batch = test::batch_of({rod}, {.solver = solver.solver(), .max_iterations = 1});
        for (int i = 0; i < 200; ++i) REQUIRE(test::step(batch, 0.02f).recovered == 0);
        INFO(baker::name_of(kind) << ", " << count << " segments, E " << young);
        const rods::SegmentPose root = batch.pose(0, 0);
        CHECK(test::distance(batch.pose(0, count - 1).position_m, root.position_m) < 1.5 * 4);
      }
    }
  }
}

TEST_CASE("the_residual_of_cg_falls_with_iterations") {
  const test::Segments rod = test::straight_rod({.segments = 20, .young_pa = 1e5f});
  test::RodBatch fallen = test::batch_of({rod}, {.max_iterations = 50, .tolerance_rad = 1e-4f});
  for (int i = 0; i < 12; ++i) test::step(fallen, 0.02f);
  double before = HUGE_VAL;
  for (const uint32_t iterations : {1u, 2u, 3u, 5u, 12u}) {
    baker::ComparedSolver solver = {.kind = SolverKind::kCg, .cg = {.tolerance = 1e-6f}};
    test::RodBatch batch = test::batch_of({rod}, {.solver = solver.solver(),
                                                  .start = rods::RodStart::kZero,
                                                  .max_iterations = iterations,
                                                  .tolerance_rad = 1e-6f,
                                                  .report_residual = true});
    REQUIRE(batch.take_state(fallen).ok());
    const double residual = static_cast<double>(test::step(batch, 0.02f).residual);
    CHECK(residual < std::max(1.01 * before, 2e-6));  // what the last ones leave is rounding
    before = residual;
  }
  CHECK(before < 3e-6);
}

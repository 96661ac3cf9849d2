// test_residual.cpp  What a step says its equations miss by.
#include <catch2/catch.hpp>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

// One more step of a soft rod that has fallen for a while, with this many iterations.
struct Tried {
  rods::RodReport report;
  double stretch, error;  // of its own segment's length; from the step with all iterations, of the mean's
};

class Fallen {
 public:
  Fallen(rods::RodSolver solver, rods::RodStart start) : solver_(solver), start_(start) {
    now_ = test::batch_of({rod_}, {.max_iterations = 50, .tolerance_rad = 1e-4f});
    for (int i = 0; i < 12; ++i) test::step(now_, 0.02f);
    converged_ = test::batch_of({rod_}, {.max_iterations = 50, .tolerance_rad = 1e-5f});
    REQUIRE(converged_.take_state(now_).ok());
    test::step(converged_, 0.02f);
  }
  Tried with(uint32_t iterations) const {
    test::RodBatch batch = test::batch_of({rod_}, {.solver = solver_,
                                                   .start = start_,
                                                   .max_iterations = iterations,
                                                   .tolerance_rad = 1e-6f,
                                                   .cg_tolerance = 1e-6f,
                                                   .report_residual = true});
    REQUIRE(batch.take_state(now_).ok());
    const rods::RodReport report = test::step(batch, 0.02f);
    double error = 0;
    for (uint32_t i = 0; i < rod_.size(); ++i) {
      error = std::max(error, test::distance(batch.pose(0, i).position_m, converged_.pose(0, i).position_m));
    }
    return {report, test::largest_stretch(batch, rod_), error / static_cast<double>(rod_[0].length_m)};
  }

 private:
  test::Segments rod_ = test::straight_rod({.segments = 20, .young_pa = 1e5f});
  rods::RodSolver solver_;
  rods::RodStart start_;
  test::RodBatch now_, converged_;
};

}  // namespace

TEST_CASE("a_residual_is_reported_only_where_it_is_asked_for") {
  test::RodBatch batch = test::batch_of({test::straight_rod({})}, {.max_iterations = 1});
  for (int i = 0; i < 5; ++i) CHECK(test::step(batch, 0.02f).residual == 0);
}

TEST_CASE("asking_for_the_residual_changes_no_step") {
  test::RodBatch asked = test::batch_of({test::helix(20)}, {.report_residual = true});
  test::RodBatch plain = test::batch_of({test::helix(20)});
  for (int i = 0; i < 30; ++i) {
    CHECK(test::step(asked, 0.02f).residual > 0);
    test::step(plain, 0.02f);
    for (uint32_t k = 0; k < 20; ++k) {
      CHECK(test::distance(asked.pose(0, k).position_m, plain.pose(0, k).position_m) == 0);
    }
  }
}

TEST_CASE("the_residual_falls_with_iterations_and_never_hides_a_stretch_or_an_error") {
  const auto solver = GENERATE(rods::RodSolver::kDirect, rods::RodSolver::kCg);
  const auto start = GENERATE(rods::RodStart::kZero, rods::RodStart::kPrevious);
  const Fallen fallen(solver, start);
  double first = 0, before = HUGE_VAL;
  for (const uint32_t k : {1u, 2u, 3u, 5u, 12u}) {
    const Tried tried = fallen.with(k);
    const double residual = static_cast<double>(tried.report.residual);
    if (k == 1) first = residual;
    INFO(k << " iterations: residual " << residual << ", stretch " << tried.stretch << ", error "
           << tried.error);
    // What the last iterations leave is rounding: 1e-6, here and in stretch.
    CHECK(residual < std::max(1.01 * before, 2e-6));
    CHECK(tried.stretch < 1.01 * residual + 1e-6);
    // Errors add up along the rod, over 20 segments.
    CHECK(tried.error < 20 * residual + 1e-5);
    before = residual;
  }
  CHECK(first > 1e-4);
  CHECK(before < 3e-6);
}

TEST_CASE("a_body_in_free_fall_leaves_no_residual") {
  const test::Segments rod = test::straight_rod({.held = false});
  test::RodBatch batch = test::batch_of({rod}, {.max_iterations = 1, .report_residual = true});
  for (int i = 0; i < 10; ++i) CHECK(test::step(batch, 0.02f).residual < 1e-6f);  // rounding
}

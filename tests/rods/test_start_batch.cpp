// test_start_batch.cpp  Starts that continue the last steps.
#include "tests/pack/count_allocations.hpp"
#include "tests/rods/start_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;

namespace {

constexpr float kDt_s = 0.02f;

double cost_of(test::RodSettings settings, rods::RodStart start, int steps = 100) {
  settings.start = start;
  test::RodBatch batch = test::batch_of({test::straight_rod({.segments = 20, .young_pa = 1e5f})}, settings);
  double cost = 0;
  for (int i = 0; i < steps; ++i) {
    cost += test::step(batch, kDt_s).iterations_sum;
  }
  return cost;
}

double largest_difference(const test::RodBatch& a, const test::RodBatch& b) {
  double largest = 0;
  for (uint32_t i = 0; i < a.segment_count(); ++i) {
    largest = std::max(largest, test::distance(a.pose(0, i).position_m, b.pose(0, i).position_m));
  }
  return largest;
}

}  // namespace

TEST_CASE("what_moves_on_a_parabola_is_continued_on_it") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    test::StartLanes<16> group({0, 0});
    group.start.inputs = nullptr;
    // Each number another one, for one alone is also continued by other shares of its changes.
    const auto parabola = [](uint32_t k, float t) {
      const float bend[3] = {0, 0.5f, -0.25f}, slope[3] = {1, -3, 2};
      return 3 + slope[k % 3] * t + bend[k % 3] * t * t;
    };
    for (uint32_t t = 0; t < 6; ++t) {
      for (uint32_t k = 0; k < simd::kRodStartNumbers; ++k) {
        group.fill(group.at(1, simd::kRodStartPush + k), parabola(k, static_cast<float>(t)));
      }
      group.know(t + 1);
      group.calls(kernels).continue_start(group.job, group.start);
      group.start.newest = (group.start.newest + 1) % simd::kRodStartAges;
      const auto next = static_cast<float>(t < simd::kRodStartAges ? t : t + 1);
      // The fit of two nearly parallel changes is damped; the last step by itself would be off by up to 2.5.
      for (uint32_t k = 0; k < simd::kRodStartNumbers; ++k) {
        for (uint32_t lane = 0; lane < 16; ++lane) {
          CHECK(group.at(1, simd::kRodStartPush + k)[lane] == Approx(parabola(k, next)).margin(0.1));
        }
      }
    }
  });
}

TEST_CASE("a_continued_start_needs_fewer_iterations_than_the_last_step_and_that_fewer_than_none") {
  test::RodSettings settings;
  settings.tolerance_rad = 1e-3f;
  const double zero = cost_of(settings, rods::RodStart::kZero),
               previous = cost_of(settings, rods::RodStart::kPrevious),
               continued = cost_of(settings, rods::RodStart::kContinued);
  CHECK(previous < 0.95 * zero);
  CHECK(continued < 0.8 * previous);
}

// Where a step ends is a matter of its tolerance: 1e-4 of a segment's length after 30 steps at 1e-5 rad, what
// a bad guess would leave by itself being a thousand times that.
TEST_CASE("where_a_step_ends_does_not_depend_on_what_guesses_its_start") {
  const test::RandomCopingNet network;
  const test::Segments rod = test::helix(12, 0.1, 1e5f);
  test::RodSettings settings;
  settings.max_iterations = 100;
  settings.tolerance_rad = 1e-5f;
  settings.network = &network.net();
  settings.start = rods::RodStart::kZero;
  test::RodBatch zero = test::batch_of({rod}, settings);
  for (int i = 0; i < 30; ++i) REQUIRE(test::step(zero, kDt_s).unconverged == 0);
  for (const auto start : {rods::RodStart::kContinued, rods::RodStart::kLearned}) {
    settings.start = start;
    test::RodBatch guessed = test::batch_of({rod}, settings);
    for (int i = 0; i < 30; ++i) REQUIRE(test::step(guessed, kDt_s).unconverged == 0);
    CHECK(largest_difference(zero, guessed) < 1e-5);
  }
}

TEST_CASE("rods_keep_their_length_whatever_guesses_their_start") {
  const test::RandomCopingNet network;
  for (const float young : {1e4f, 1e6f, 1e9f}) {
    const test::Segments rod = test::straight_rod({.segments = 20, .young_pa = young});
    test::RodSettings settings;
    settings.start = rods::RodStart::kLearned;
    settings.network = &network.net();
    test::RodBatch batch = test::batch_of({rod}, settings);
    for (int i = 0; i < 500; ++i) {
      test::step(batch, kDt_s);
      REQUIRE(std::fabs(test::length_ratio(batch, rod) - 1) < 1e-3);  // the bound
    }
  }
}

TEST_CASE("a_start_that_did_not_serve_is_forgotten") {
  test::RodSettings settings;
  settings.start = rods::RodStart::kContinued;
  settings.keeps_start_inputs = true;
  settings.max_iterations = 1;
  settings.tolerance_rad = 1e-6f;
  test::RodBatch batch = test::batch_of({test::straight_rod({.segments = 8, .young_pa = 1e4f})}, settings);
  for (int i = 0; i < 6; ++i) REQUIRE(test::step(batch, kDt_s).unconverged == 1);
  for (const float x : batch.start_inputs(0, 5).continued) CHECK(x == 0);
}

TEST_CASE("a_strands_start_does_not_depend_on_its_neighbours") {
  const test::RandomCopingNet network;
  test::RodSettings settings;
  settings.start = rods::RodStart::kLearned;
  settings.network = &network.net();
  const test::Segments soft = test::helix(8, 0.1, 1e3f), stiff = test::helix(8, 0.1, 1e7f);
  test::RodBatch both = test::batch_of({stiff, soft}, settings), alone = test::batch_of({soft}, settings);
  for (int i = 0; i < 20; ++i) {
    test::step(both, kDt_s);
    test::step(alone, kDt_s);
  }
  for (uint32_t i = 0; i < 8; ++i) {
    CHECK(test::distance(both.pose(1, i).position_m, alone.pose(0, i).position_m) == 0);
  }
}

TEST_CASE("a_step_with_a_guessed_start_allocates_nothing") {
  const test::RandomCopingNet network;
  test::RodSettings settings;
  settings.network = &network.net();
  for (const auto start : {rods::RodStart::kContinued, rods::RodStart::kLearned}) {
    settings.start = start;
    test::RodBatch batch = test::batch_of({test::helix(10)}, settings);
    const size_t before = test::allocation_count();
    for (int i = 0; i < 10; ++i) test::step(batch, kDt_s);
    CHECK(test::allocation_count() == before);
  }
}

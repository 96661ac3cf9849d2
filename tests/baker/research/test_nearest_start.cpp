// test_nearest_start.cpp  Starts by the nearest examples.
#include "baker/research/rods/nearest_start.hpp"

#include <functional>

#include "baker/common/bad_input.hpp"
#include "tests/pack/count_allocations.hpp"
#include "tests/rods/start_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using Catch::Contains;

namespace {

constexpr float kDt_s = 0.02f;

// Three examples at one place, whose mean answer is `answer` everywhere, and one far away.
struct MadeUpExamples {
  explicit MadeUpExamples(float answer, float far = 100) {
    for (const float by : {-0.5f, 0.0f, 0.5f, far}) {
      inputs.insert(inputs.end(), simd::kRodStartInputs, by == far ? far : 0.0f);
      answers.insert(answers.end(), simd::kRodStartNumbers, by == far ? far : answer + by);
    }
  }
  std::vector<float> inputs, answers;
};

}  // namespace

TEST_CASE("examples_that_are_too_few_cut_or_not_finite_are_refused") {
  MadeUpExamples examples(1);
  const std::span<const float> inputs = examples.inputs, answers = examples.answers;
  const auto message = [](std::span<const float> some_inputs, std::span<const float> some_answers) {
    try {
      baker::NearestStart(some_inputs, some_answers);
    } catch (const baker::BadInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(message({}, {}), Contains("examples of starts: 0; give 3"));
  CHECK_THAT(message(inputs.first(2 * simd::kRodStartInputs), answers.first(2 * simd::kRodStartNumbers)),
             Contains("examples of starts: 2; give 3"));
  CHECK_THAT(message(inputs.first(inputs.size() - 1), answers), Contains("55 numbers of inputs and 48"));
  CHECK_THAT(message(inputs, answers.first(36)), Contains("56 numbers of inputs and 36 of outputs"));
  examples.answers[40] = HUGE_VALF;
  CHECK_THAT(message(inputs, answers), Contains("a number is not finite"));
  examples.answers[40] = 0;
  CHECK(message(inputs, answers).empty());
}

TEST_CASE("a_guess_is_the_mean_of_the_three_nearest_answers") {
  const MadeUpExamples examples(2);
  const baker::NearestStart nearest(examples.inputs, examples.answers);
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    test::StartLanes<16> group({0, 0});
    baker::rod_research_calls(16).add_nearest(group.job, group.start, nearest.rows());
    for (uint32_t k = 0; k < simd::kRodStartNumbers; ++k) {
      for (uint32_t lane = 0; lane < 16; ++lane) {
        CHECK(group.at(1, simd::kRodStartPush + k)[lane] == Approx(2).margin(1e-6));
        // The root has no joint.
        CHECK(group.at(0, simd::kRodStartPush + k)[lane] == Approx(k < 6 ? 2 : 0).margin(1e-6));
      }
    }
  });
}

TEST_CASE("lanes_have_neighbours_of_their_own") {
  const MadeUpExamples examples(2, 100);
  const baker::NearestStart nearest(examples.inputs, examples.answers);
  test::StartLanes<4> group({0, 0});
  for (uint32_t k = 0; k < simd::kRodStartInputs; ++k) {
    group.start.inputs[(simd::kRodStartInputs + k) * 4 + 3] = 100;
  }
  baker::rod_research_calls(4).add_nearest(group.job, group.start, nearest.rows());
  CHECK(group.at(1, simd::kRodStartPush)[0] == Approx(2));
  CHECK(group.at(1, simd::kRodStartPush)[3] == Approx((100 + 1.5 + 2) / 3));  // ties keep the earlier two
}

// 1e-4 of a segment's length after 30 steps at 1e-5 rad, what the guess would leave by itself being a
// thousand times that.
TEST_CASE("where_a_step_ends_does_not_depend_on_examples_and_they_allocate_nothing") {
  const MadeUpExamples examples(2);
  baker::NearestStart nearest(examples.inputs, examples.answers);
  const test::Segments rod = test::helix(12, 0.1, 1e5f);
  test::RodSettings settings;
  settings.max_iterations = 100;
  settings.tolerance_rad = 1e-5f;
  settings.start = rods::RodStart::kContinued;
  test::RodBatch plain = test::batch_of({rod}, settings);
  settings.correction = nearest.correction();
  test::RodBatch guessed = test::batch_of({rod}, settings);
  const size_t before = test::allocation_count();
  uint32_t unconverged = 0, plain_iterations = 0, iterations = 0;
  for (int i = 0; i < 30; ++i) {
    const test::RodReport with_plain = test::step(plain, kDt_s), report = test::step(guessed, kDt_s);
    unconverged += with_plain.unconverged + report.unconverged;
    plain_iterations += with_plain.iterations;
    iterations += report.iterations;
  }
  CHECK(test::allocation_count() == before);
  CHECK(unconverged == 0);
  CHECK(iterations > plain_iterations);  // answers that mean nothing were listened to
  for (uint32_t i = 0; i < 12; ++i) {
    CHECK(test::distance(plain.pose(0, i).position_m, guessed.pose(0, i).position_m) < 1e-5);
  }
}

// test_knn_start.cpp  Starts by the nearest examples.
#include "rods/knn_start.hpp"

#include "tests/rods/start_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using Catch::Contains;

TEST_CASE("examples_that_are_too_few_cut_or_not_finite_are_refused") {
  test::RodBatch batch;
  test::RodSettings settings;
  settings.start = rods::RodStart::kKnn;
  const auto message = [&] {
    const Status status = test::try_batch({test::helix(4)}, settings, &batch);
    CHECK((status.ok() || batch.strand_count() == 0));
    return std::string(status.ok() ? "" : status.message);
  };
  CHECK_THAT(message(), Contains("RodSettings::examples holds 0; kKnn needs 3"));
  test::MadeUpExamples examples(1);
  settings.examples = &examples.view;
  const rods::StartExamples all = examples.view;
  examples.view.inputs = all.inputs.first(2 * simd::kRodStartInputs);
  CHECK_THAT(message(), Contains("RodSettings::examples holds 2; kKnn needs 3"));
  examples.view.inputs = all.inputs.first(all.inputs.size() - 1);
  CHECK_THAT(message(), Contains("55 numbers of inputs and 48 of answers"));
  examples.view = {all.inputs, all.answers.first(36)};
  CHECK_THAT(message(), Contains("56 numbers of inputs and 36 of answers"));
  examples.view = all;
  examples.answers[40] = HUGE_VALF;
  CHECK_THAT(message(), Contains("RodSettings::examples: number 40 is not finite"));
  examples.answers[40] = 0;
  CHECK(message().empty());
}

TEST_CASE("a_guess_is_the_mean_of_the_three_nearest_answers") {
  const test::MadeUpExamples examples(2);
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    test::StartLanes<16> group({0, 0});
    group.calls(kernels).add_nearest(group.job, group.start, rods::start_examples(examples.view));
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
  const test::MadeUpExamples examples(2, 100);
  test::StartLanes<4> group({0, 0});
  for (uint32_t k = 0; k < simd::kRodStartInputs; ++k) {
    group.start.inputs[(simd::kRodStartInputs + k) * 4 + 3] = 100;
  }
  group.calls(simd::kernels()).add_nearest(group.job, group.start, rods::start_examples(examples.view));
  CHECK(group.at(1, simd::kRodStartPush)[0] == Approx(2));
  CHECK(group.at(1, simd::kRodStartPush)[3] == Approx((100 + 1.5 + 2) / 3));  // ties keep the earlier two
}

// test_rod_run.cpp  What is written down of a run is what the solver did.
#include "baker/rods/rod_run.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sinew;

namespace {

baker::RodLine short_line(uint32_t steps) {
  baker::RodLine line;
  line.scene = "bending_rod";
  line.split = "train";
  line.range = {baker::RodKind::kBendingRod, 8, 8, 1e6, 1e6, 1};
  line.steps = steps;
  return line;
}

}  // namespace

TEST_CASE("a_run_holds_every_step_and_its_start_in_a_strands_own_units") {
  constexpr uint32_t kSteps = 12, kSegments = 8;
  const baker::Safetensors run = baker::simulate_rod(short_line(kSteps), {}, 3);
  const std::vector<float> forces = run.need("forces", {kSteps + 1, kSegments, 12}).as_f32(),
                           continued = run.need("continued", {kSteps, kSegments, 12}).as_f32();
  run.need("turns", {kSteps, kSegments, 4});
  run.need("joints", {kSegments, 5});
  run.need("parents", {kSegments});
  const std::vector<float> inputs = run.need("inputs", {kSteps, kSegments, 14}).as_f32(),
                           scales = run.need("scales", {kSteps, 4}).as_f32();
  for (uint32_t k = 0; k < kSegments * 12; ++k) {
    CHECK(forces[k] == 0);
    // Until four steps are known a start repeats the last one.
    CHECK(continued[3 * kSegments * 12 + k] == Approx(forces[3 * kSegments * 12 + k]).margin(1e-4));
  }
  // What the start of step 11 is told: by how much that of step 10 missed, in force over its r.m.s.
  const size_t told = 11, row = kSegments * 12;
  for (uint32_t i = 1; i < kSegments; ++i) {
    double missed = 0, input = 0;
    for (uint32_t k = 6; k < 9; ++k) {
      const auto by =
          static_cast<double>(forces[told * row + i * 12 + k] - continued[(told - 1) * row + i * 12 + k]);
      missed += by * by;
      input += std::pow(static_cast<double>(inputs[(told * kSegments + i) * 14 + k]), 2);
    }
    // Floats of forces whose tenth of a per mille is a hundredth of what was missed.
    CHECK(std::sqrt(input) * static_cast<double>(scales[told * 4 + 2]) ==
          Approx(std::sqrt(missed)).epsilon(0.02).margin(1e-3));
  }
}

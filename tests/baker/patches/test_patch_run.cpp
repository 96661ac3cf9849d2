// test_patch_run.cpp  What a run of a body says.
#include <catch2/catch.hpp>

#include <cmath>

#include "baker/patches/patch_run.hpp"

using namespace sinew;

namespace {

baker::PatchLine small_line() {
  baker::PatchLine line;
  line.shape = "cylinder", line.split = "test", line.kind = baker::BodyShape::kCylinder;
  line.least_size = line.most_size = 4;
  line.least_stiffness = line.most_stiffness = 40;
  line.ticks = 12;
  return line;
}

}  // namespace

TEST_CASE("a_run_begins_at_rest_and_its_held_nodes_never_leave_the_pose") {
  const baker::Safetensors run = baker::simulate_patches(small_line(), {}, 1, false);
  const auto displacement = run.tensors.at("displacement").as_f32();
  const auto constrained = run.tensors.at("constrained").as_i32();
  const size_t n = constrained.size();
  REQUIRE(displacement.size() == 13 * n * 3);
  float most = 0;
  for (size_t t = 0; t < 13; ++t)
    for (size_t i = 0; i < n; ++i)
      for (size_t axis = 0; axis < 3; ++axis) {
        const float d = std::abs(displacement[(t * n + i) * 3 + axis]);
        if (t == 0) REQUIRE(d < 1e-6f);
        if (constrained[i] != 0) REQUIRE(d < 1e-5f);  // floats of a place
        most = std::max(most, d);
      }
  CHECK(most > 1e-3f);
}

TEST_CASE("the_same_seed_is_the_same_run_and_another_is_another") {
  const auto of = [](uint64_t seed) {
    return baker::simulate_patches(small_line(), {}, seed, false).tensors.at("displacement").as_f32();
  };
  CHECK(of(1) == of(1));
  CHECK(of(1) != of(2));
}

// Velocities are told by differences of positions, so that small steps start a little wrong; that they come
// to one answer is what counts.
TEST_CASE("explicit_steps_come_near_the_implicit_answer_as_they_shrink") {
  baker::PatchPlan plan;
  plan.damping_ratio = 0;
  plan.substeps = 16;
  baker::PatchLine line = small_line();
  line.least_stiffness = line.most_stiffness = 4;  // stable in one step
  const baker::Safetensors run = baker::simulate_patches(line, plan, 3, true);
  const auto mean = [&](const std::string& name) {
    double sum = 0;
    for (const float v : run.tensors.at(name).as_f32()) sum += static_cast<double>(v) / 12;
    return sum;
  };
  CHECK(mean("explicit.50.single") < 0.01);  // of a cell
  CHECK(std::abs(mean("explicit.100.single") / mean("explicit.50.single") - 1) < 0.1);
  line.least_stiffness = line.most_stiffness = 400;
  const auto stiff = baker::simulate_patches(line, plan, 3, true).tensors.at("explicit.1.rolled").as_f32();
  CHECK(stiff.back() > 10);  // one step a tick explodes
}

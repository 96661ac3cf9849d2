// rod_run.hpp  One run of a plan, simulated and written down for the trainer.
#pragma once
#include "baker/common/bad_input.hpp"
#include "baker/common/files/safetensors.hpp"
#include "baker/rods/rod_plan.hpp"

namespace sinew::baker {

struct NoTruth : BadInput {
  using BadInput::BadInput;
};

// In the strand's own units: its mean segment's length and mass, and seconds. S steps, N segments.
//   forces     [S + 1][N][12]  what the solver found, before the first step (zeros) and after each:
//   acceleration
//                              (world) and angular acceleration (own axes) by the joints, the joint's force
//                              (world) and moment
//   turns      [S][N][4]       orientation x y z w at each step's start
//   inputs     [S][N][14]      what a learned start is told of the step (kernels/rods/rod_start_job.hpp)
//   continued  [S][N][12]      and what it corrects, as forces
//   scales     [S][4]          by which it measures the correction, triple by triple
//   joints     [N][5]          what it is told of the joints, the root's zero
//   iterations [S]             Newton's, from `continued`
//   parents    [N]             the root's is itself
// Throws NoTruth where a step does not converge.
Safetensors simulate_rod(const RodLine& line, const RodPlan& plan, uint64_t seed);

// The root is put where its motion is at the end of the step.
void drive_root(const RodScene& scene, double time_s, uint32_t strand, rods::RodBatch* batch);

}  // namespace sinew::baker

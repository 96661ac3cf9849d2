// patch_run.hpp  One run of a plan, simulated and written down for the trainer.
#pragma once
#include "baker/common/files/safetensors.hpp"
#include "baker/patches/patch_plan.hpp"

namespace sinew::baker {

// In cells, ticks, and the mass of a full cell. T ticks after the start at rest, N nodes:
//   rest [N][3], constrained [N]
//   edges [E][2]                  each once
//   place [T + 1][3]              of the rigid motion that holds the body
//   turn [T + 1][9]               the same, world from body, row-major
//   material [N][3]               ln k, m, ln (k / m): stiffness and mass of the node's share of tetrahedra
//   displacement [T + 1][N][3]    along the body's axes of that tick
// and, of a test run that asks for it, what explicit central differences leave in 1, 50 and 100 substeps:
//   explicit.{S}.single, .rolled [T]   root mean square over free nodes, from the truth's states; rolled out
// The body's first mode, rad a tick, is the metadata's `first`. Throws std::runtime_error where a step does
// not converge.
Safetensors simulate_patches(const PatchLine& line, const PatchPlan& plan, uint64_t seed, bool with_explicit);

}  // namespace sinew::baker

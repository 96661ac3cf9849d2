// patch_plan.hpp  Which bodies to simulate for training an emulator of patches: a JSON file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "baker/patches/voxel_body.hpp"

namespace sinew::baker {

// "split" of a line. Only what trains is learned from; validation chooses; test is looked at once.
inline constexpr const char* kPatchSplits[] = {"train", "validation", "test"};

struct PatchLine {
  std::string shape, split;
  BodyShape kind = BodyShape::kSphere;
  uint64_t first_seed = 1;                           // 1 .. 1e12; the line's runs have this and the next ones
  uint32_t runs = 1;                                 // 1 .. 100000
  uint32_t ticks = 100;                              // 4 .. 10000
  double least_size = 3, most_size = 6;              // cells, 2 .. 20
  double least_stiffness = 1, most_stiffness = 100;  // Young's modulus x tick^2 / (density x cell^2); > 0
  uint32_t stiffnesses = 0;        // so many of them, evenly on a logarithmic scale, in turn; 0: any, drawn
  double most_acceleration = 1.5;  // cells a tick^2, of what holds it; 1e-3 .. 10
  bool is_painted = false;         // stiffness changes along the body
};

struct PatchPlan {
  double rate_hz = 60;          // ticks, 10 .. 240
  uint32_t substeps = 4;        // of a tick, 1 .. 64
  bool backward_euler = false;  // else BDF2
  double damping_ratio = 0.1;   // Rayleigh, of the first mode; 0: none but the integrator's own
  std::vector<PatchLine> lines;
};

// Throws BadInput: not JSON, an unknown key, a number out of range, two lines that share a seed of a shape.
PatchPlan read_patch_plan(const std::string& path);

}  // namespace sinew::baker

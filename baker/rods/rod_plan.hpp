// rod_plan.hpp  Which rods to simulate for training, and which are held out: a JSON file.
#pragma once
#include <string>
#include <vector>

#include "baker/rods/rod_scene.hpp"

namespace sinew::baker {

// "split" of a line. Only what trains is learned from; validation chooses; test and long are looked at once.
inline constexpr const char* kRodSplits[] = {"train", "validation", "test", "long"};

struct RodLine {
  std::string scene, split;
  RodRange range;
  uint64_t first_seed = 1;  // 1 .. 2^40; the line's runs have this and the next ones
  uint32_t runs = 1;        // 1 .. 100000
  uint32_t steps = 50;      // 3 .. 100000
};

struct RodPlan {
  double dt_s = 0.02;           // 1e-3 .. 0.1
  double tolerance_rad = 2e-5;  // 1e-6 .. 1e-2, of the truth
  std::vector<RodLine> lines;
};

// Throws BadInput: not JSON, an unknown key, a number out of range, two lines that share a seed of a scene.
RodPlan read_rod_plan(const std::string& path);

}  // namespace sinew::baker

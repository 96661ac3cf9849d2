// summary.hpp  A run in numbers: what the table prints and the report begins with.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "samples/demo/simulate.hpp"
#include "samples/demo/statistics.hpp"

namespace sinew::demo {

struct StageTime {
  std::string name;
  Spread us;
};

struct TierShare {
  std::string name;
  Tier tier = Tier::kSkinning;
  double share = 0;                              // of instances x frames
  double baked_cost_us = 0, baked_error_mm = 0;  // NaN: not in the pack, or not measured
};

struct ReasonShare {
  std::string name;
  double share = 0;  // of instances x frames
};

// Of the first instance's rods, over the frames in which they were stepped.
struct RodWork {
  Spread iterations;  // a rod and tick
  Spread residual;    // InstanceReport::rod_residual
};

struct Summary {
  std::vector<ReasonShare> reasons;
  // A share of skinning's, mean of the instances, over frames; null: not measured for all tiers that were
  // used.
  std::optional<Spread> expected_error;
  Spread unspent;               // of the budget, over the frames in which it kept an instance below its best
  std::vector<StageTime> step;  // the step's stages, then the whole step
  std::vector<StageTime> engine;  // what the engine does around it
  std::vector<TierShare> tiers;
  uint64_t over_budget = 0, cut = 0, restarts = 0, input_clamps = 0, displacement_clamps = 0,
           rejected_poses = 0;
  double dropped_s = 0;
  double expected_error_mm = 0;  // mean of the tiers' baked errors by share; NaN: not measured
  RodWork rods;
  Spread skinning_error_mm, sinew_error_mm;  // over frames; of the first instance
};

RodWork rod_work(const Run& run);
Summary summarise(const Run& run, const CharacterFile& character);

// other: the run beside it, whose parts are told too; null: none.
void print_table(const Summary& summary, const Run& run, const Run* other, const CharacterFile& character,
                 const Options& options);

// Throws baker::BadInput when the path cannot be written.
void write_report(const std::string& path, const Summary& summary, const Run& run, const Run* other,
                  const CharacterFile& character, const Options& options);

}  // namespace sinew::demo

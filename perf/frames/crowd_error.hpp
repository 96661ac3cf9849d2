// crowd_error.hpp  How far a crowd under a budget truly is from recorded truth, beside what was expected of
// it.
//
// Each instance follows one of the motions, over and over, at its own phase. Where a motion begins anew the
// instance is reset: there the truth is at rest on the skinning, too. Told are the frames after all have come
// to their motion's start; before, their past is not the truth's, and costs are learnt. Distances are means
// over the vertices that tissue moves, as sinew-trade takes them.
#pragma once
#include <span>
#include <vector>

#include "samples/demo/character_file.hpp"
#include "samples/demo/trajectory.hpp"
#include "sinew/types.hpp"

namespace sinew::perf {

struct CrowdDef {
  uint32_t instances = 100;
  float budget_us = 4000;
  BudgetMode mode = BudgetMode::kTime;
};

// Sums over the told frames of instances. `weight` is an instance's importance: weight times millimetres is
// what the scheduler spends for.
class ErrorSums {
 public:
  void add(double weight, double skinning_mm, double error_mm, const InstanceReport& report);
  void add(const ErrorSums& other);

  double skinning_mm() const { return skinning_mm_ / count_; }
  // Shares of the instances: that were not simulated, and that were cut.
  double left_alone() const { return left_alone_ / count_; }
  double cut() const { return cut_ / count_; }
  // Shares of skinning's: of the tiers' errors as baked, each instance and frame alike, as
  // FrameReport::expected_error; the same by what skinning is off there and then; and as measured.
  double expected() const { return expected_ / count_; }
  double expected_of_mm() const { return expected_mm_ / skinning_mm_; }
  double measured() const { return error_mm_ / skinning_mm_; }
  double weighted_expected() const { return weighted_expected_mm_ / weighted_skinning_mm_; }
  double weighted_measured() const { return weighted_error_mm_ / weighted_skinning_mm_; }

 private:
  double count_ = 0, left_alone_ = 0, cut_ = 0, expected_ = 0;
  double skinning_mm_ = 0, expected_mm_ = 0, error_mm_ = 0;
  double weighted_skinning_mm_ = 0, weighted_expected_mm_ = 0, weighted_error_mm_ = 0;
};

struct CrowdError {
  std::vector<ErrorSums> motions;  // one for each
  std::vector<double> cpu_us;      // of each told frame's step
};

// As many told frames as the longest motion has. Throws baker::BadInput.
CrowdError measure_crowd(const demo::CharacterFile& character, std::span<const demo::Trajectory> motions,
                         const CrowdDef& def);

}  // namespace sinew::perf

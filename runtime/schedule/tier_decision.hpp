// tier_decision.hpp  What an instance gets in a step, and why.
#pragma once
#include <cstdint>

#include "sinew/types.hpp"

namespace sinew::frame {

struct TierDecision {
  float cost_us = 0;  // expected
  // What those which run later are expected to take; idle ones as one step in twenty does.
  float behind_us = 0;
  uint32_t level = 0;  // of control graphs
  Tier tier = Tier::kSkinning;
  TierReason why = TierReason::kBudget;
};

}  // namespace sinew::frame

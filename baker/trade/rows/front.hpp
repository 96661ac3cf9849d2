// front.hpp  Which ways to run a character are worth having: no other is cheaper and nearer the truth.
#pragma once
#include <vector>

#include "baker/trade/rows/row.hpp"

namespace sinew::baker {

// Fills in dominated_by: by the mean step, warm, and the error's ratio. Tiers are compared among themselves,
// variants with all. Skinning is what all else is measured against, and extrapolate is what becomes of any
// other; neither is dominated, and extrapolate, which needs another before it, dominates
// nothing; nor does a rate that the scheduler does not buy.
void find_dominated(std::vector<Row>* rows);

}  // namespace sinew::baker

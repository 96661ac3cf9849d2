// crowd_table.hpp  What crowds are off, as CSV on standard output.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "samples/demo/character_file.hpp"
#include "sinew/types.hpp"

namespace sinew::perf {

struct CrowdOptions {
  std::vector<std::string> truths;  // of sinew-bake truth --positions
  uint32_t instances = 100;
  std::vector<float> budgets_us = {4000, std::numeric_limits<float>::infinity()};
  BudgetMode mode = BudgetMode::kTime;
};

// For each budget a row of the whole crowd, and one for each name of a motion. Throws baker::BadInput.
void put_crowd_errors(const demo::CharacterFile& character, const CrowdOptions& options);

}  // namespace sinew::perf

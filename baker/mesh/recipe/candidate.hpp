// candidate.hpp  A soft part that a character may have, as its recipe would state it.
#pragma once
#include <string>

#include "baker/mesh/recipe/evidence.hpp"
#include "baker/mesh/recipe/recipe.hpp"

namespace sinew::baker {

struct Candidate {
  RegionRecipe region;
  Evidence evidence = Evidence::kBoneName;
  std::string why;    // what says so
  std::string doubt;  // what speaks against it; empty where it is certain
};

}  // namespace sinew::baker

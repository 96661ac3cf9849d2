// skin_weight.hpp  How much of a vertex some joints move.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

inline double weight_on(const Influences& skin, const std::vector<bool>& joints) {
  double sum = 0;
  for (size_t k = 0; k < kInfluences; ++k)
    if (joints[static_cast<size_t>(skin.joint[k])]) sum += skin.weight[k];
  return sum;
}

}  // namespace sinew::baker

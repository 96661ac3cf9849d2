// variants.hpp  The character baked otherwise: control graphs of other sizes, other networks.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "baker/measure/loaded_pack.hpp"
#include "baker/trade/source/baked_from.hpp"

namespace sinew::baker {

struct Variant {
  std::string name;
  std::function<LoadedPack()> bake;  // throws BadInput as sinew-bake character does
};

// None without a glb; of networks none without weights. The source must outlive them.
std::vector<Variant> variants_of(const BakedFrom& source);

}  // namespace sinew::baker

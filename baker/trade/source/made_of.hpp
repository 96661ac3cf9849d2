// made_of.hpp  All that measured rows depend on, by name.
#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "baker/measure/loaded_pack.hpp"
#include "baker/measure/true_surface.hpp"
#include "baker/trade/source/baked_from.hpp"

namespace sinew::baker {

// An object of strings: of what code, processor and instruction set the costs are, of what character, and
// what its variants are baked from.
nlohmann::ordered_json made_of(const LoadedPack& character, std::span<const TrueSurface> surfaces,
                               const BakedFrom& source);

}  // namespace sinew::baker

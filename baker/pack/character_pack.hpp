// character_pack.hpp  A character, its tissue and its network to one .sinew file.
#pragma once
#include <cstddef>
#include <vector>

#include "baker/common/safetensors.hpp"
#include "baker/import/character.hpp"
#include "baker/mesh/tissue_layout.hpp"

namespace sinew::baker {

inline constexpr double kClipRateHz = 60;
// The whole file. Beyond network_pack's keys, reads from the weights' metadata: error_mm, error_ratio (of the
// network on held-out motion; absent: not measured). Throws BadInput: weights without `inputs`, more than
// 65,535 joints, a clip of more than ten minutes, and what add_network refuses.
std::vector<std::byte> pack_character(const Character& character, const TissueLayout& layout,
                                      const Safetensors& weights);

}  // namespace sinew::baker

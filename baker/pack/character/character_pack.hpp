// character_pack.hpp  A character, its tissue and its network to one .sinew file.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "baker/import/character/character.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/truth/graph_level.hpp"

namespace sinew::baker {

inline constexpr double kClipRateHz = 60;
// The whole file; `modes`: one basis a region; `coarser`: control graphs beside it, each with fewer nodes,
// where it has any, than the one before. Without weights (null) it has the tier modal, at 60 Hz.
// rod_weights: of a COPINGNet that rods may start from (null: none does). emulator: of a DeepEmulator that
// predicts the regions that stand on voxels (null: they have modes alone), which then want no `coarser`.
// Beyond network_pack's keys, reads from the weights' metadata:
//   frame, base          must be "bent" and "modal_2" (bodies' whole modes; before: each region's own): what
//                        the network was trained on
// Throws BadInput: weights without `inputs`, or of another frame or base; more than 65,535 joints, a clip of
// more than ten minutes, a basis that does not fit its region, a coarser graph that is not part of the finer
// one, and what add_network and add_rod_network refuse.
std::vector<std::byte> pack_character(const Character& character, const TissueLayout& layout,
                                      const std::vector<ModalBasis>& modes,
                                      const Safetensors* weights = nullptr,
                                      std::span<const GraphLevel> coarser = {},
                                      const Safetensors* rod_weights = nullptr,
                                      const Safetensors* emulator = nullptr);

}  // namespace sinew::baker

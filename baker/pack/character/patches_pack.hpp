// patches_pack.hpp  What emulated regions are predicted by, to a character's patch sections.
#pragma once
#include "baker/common/files/safetensors.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/pack/pack_writer.hpp"

namespace sinew::baker {

// Throws BadInput naming the key: weights of another model, without frame "going_on", or of another rate.
void check_emulator(const Safetensors& weights, double rate_hz);

// Sections kPatch... of regions with Region::cell_m; returns the network's multiply-adds a tick. Throws as
// check_emulator and add_chains do.
uint64_t add_patches(const TissueLayout& layout, const Safetensors& weights, double rate_hz,
                     PackWriter& pack);

}  // namespace sinew::baker

// emulate.hpp  A tick of the regions whose patches a network predicts (tissue/network/deep_emulator.hpp).
//
// A region's nodes are then corners of its cage's voxels, and the network's neighbours are the graph's. It
// says where each free node goes from where the last two ticks had it; how far that is from where the modal
// base would have it is taken to the modes as any network's correction is, within the same budget.
#pragma once
#include "character/instance.hpp"
#include "character/tissue/region_part.hpp"

namespace sinew::world {

inline bool is_emulated(const Part& part) noexcept { return part.record.cell_m > 0; }

// `emulated` of the awake ones: l of the coming tick as the network has it. Poses are the coming tick's, u
// the last two's, q_hat and l_hat the base's answer. False where it is not finite.
bool emulate(Instance& instance) noexcept;

}  // namespace sinew::world

// block_network.hpp  The soft block's network: a correction of its modes, as a weights file in memory.
#pragma once
#include <vector>

#include "baker/common/safetensors.hpp"
#include "baker/pack/int8_pack.hpp"
#include "tests/scenes/soft_block.hpp"

namespace sinew::scenes {

baker::Safetensors block_network(const BlockOptions& options);

// What its hidden layer hears at most: cells within +-1, of which y, their sum, forgets a fifth a tick.
std::vector<baker::HeardRanges> block_ranges();

}  // namespace sinew::scenes

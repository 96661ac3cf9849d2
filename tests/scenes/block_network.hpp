// block_network.hpp  The soft block's network: a correction of its modes, as a weights file in memory.
#pragma once
#include "baker/common/files/safetensors.hpp"
#include "tests/scenes/soft_block.hpp"

namespace sinew::scenes {

baker::Safetensors block_network(const BlockOptions& options);

}  // namespace sinew::scenes

// soft_block.hpp  A synthetic character: a soft block on two joints, as a pack in memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "core/aligned_block.hpp"
#include "tests/scenes/block_arms.hpp"
#include "tests/scenes/block_rods.hpp"

namespace sinew::scenes {

// 0.3 m wide and 0.6 m high, standing on the ground; joint 0 at its foot, joint 1 half way up. Its upper part
// is soft, in one region or in two (left and right of x = 0). Faces meet at seams: vertices there are doubled
// and welded.
//
// Its modes are block_modes.hpp's, of 3.5 Hz and above. Its network is a two-layer Alt-ConvLSTM that corrects
// them a little: it pulls the displacement towards what the felt acceleration would do to a node alone. Layer
// 0 hands drive and displacement on, layer 1 adds their difference to the base. All other weights are small
// random numbers, so that every term of the equations takes part.
struct BlockOptions {
  std::string name = "soft_block";
  int cells = 6;    // across; twice as many up: 462 vertices at 6
  int regions = 2;  // 1 or 2
  int nodes = 14;   // a region
  double rate_hz = 60;
  uint64_t seed = 1;
  double displacement_limit = 0.75;                 // share of a region's radius
  bool network = true;                              // false: modes alone
  const baker::Safetensors* weights = nullptr;      // in the place of the small network
  double frequency_share = 1;                       // of block_modes.hpp's frequencies
  std::optional<RodMatter> rods = std::nullopt;     // a tail and horns (block_rods.hpp)
  const baker::Safetensors* rod_weights = nullptr;  // of a network that rods may start from
  const baker::Safetensors* emulator = nullptr;  // predicts the first region's nodes as if they were corners
  std::vector<int> coarser_nodes = {};           // a region, of coarser control graphs
  bool leaves_out = false;                       // one graph more: the last without the left region
  std::optional<ArmMatter> arms = std::nullopt;  // block_arms.hpp
  bool tangents = false;                         // along the faces, w -1 where x is below zero
  bool clip = false;  // "nod": a second in which the upper joint turns by 1 rad about z, evenly
};

class PackBytes {  // 64-byte aligned, as load_asset wants them
 public:
  PackBytes(const std::byte* data, size_t size);
  std::span<const std::byte> bytes() const { return {memory_.data(), size_}; }

 private:
  core::AlignedBlock memory_;
  size_t size_;
};

PackBytes soft_block(const BlockOptions& options = {});

}  // namespace sinew::scenes

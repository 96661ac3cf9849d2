// strands.hpp  What is done to a rod in a batch of its own, at the extremes of what may be.
#pragma once
#include <cstdint>

namespace sinew::extremes {

struct StrandOutcome {
  // By how much any segment's end is further from the nearest segment that is held than the way along the
  // strand, over the longest such way; and 1.
  double reach = 0;
  bool finite = true;
};
inline constexpr uint32_t kStrandScenes = 6;
const char* strand_scene_name(uint32_t scene);
StrandOutcome play_strand(uint32_t scene, uint64_t seed, uint32_t steps);

}  // namespace sinew::extremes

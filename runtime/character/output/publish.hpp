// publish.hpp  What is shown at the end of a step, brought to the surface.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// Fills delta and carried from what is shown, and skin from the present pose where there are too many joints
// for whoever reads to skin them on its stack: what nobody reads is not skinned.
// Displacement is that of character/output/between_ticks.hpp, at the time of the frame: one that came a tick
// late would at 4 Hz be 2 pi 4 / 60 = 0.42 rad behind, some 40 % of its amplitude, beside a skeleton that is
// not late.
void publish(Instance& instance, const ClockHook& clock = {}) noexcept;
// Of a frame that is held: the present pose, and what was shown last.
void publish_pose(Instance& instance) noexcept;

inline constexpr uint32_t kJointsOnStack = 256;  // 12 KB
inline bool skins_on_reading(const Instance& instance) noexcept {
  return instance.level->pack.character->joint_count <= kJointsOnStack;
}

}  // namespace sinew::world

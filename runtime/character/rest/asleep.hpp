// asleep.hpp  Which of an instance's parts sleep (character/rest/sleep.hpp, character/rest/rod_sleep.hpp),
// and what wakes them.
#pragma once
#include <algorithm>

#include "character/instance.hpp"

namespace sinew::world {

// A dormant instance is stepped again (character/rest/dormant.hpp).
inline void wake(Instance& instance) noexcept { instance.state->dormant = 0; }
inline void wake_rods(Instance& instance) noexcept { instance.state->rods.quiet_ticks = 0; }
// All regions are awake: another tier, a guard, a start.
inline void wake_regions(Instance& instance) noexcept {
  std::fill_n(instance.tissue.quiet_ticks, instance.level->pack.regions.size(), 0u);
  instance.state->poses.still_ticks = 0;
}

// Quiet ones, until a region does: half a swing.
uint32_t ticks_to_sleep(const Instance& instance, size_t region) noexcept;
bool is_asleep(const Instance& instance, size_t region) noexcept;
uint32_t regions_asleep(const Instance& instance) noexcept;

inline constexpr uint32_t kRodsQuietTicks = 60;  // a second at 60 Hz: longer than half a swing of most rods
uint32_t rods_asleep(const Instance& instance) noexcept;

}  // namespace sinew::world

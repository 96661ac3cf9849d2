// asleep.cpp  see asleep.hpp.
#include "character/rest/asleep.hpp"

#include <cmath>
#include <numbers>

#include "character/parameters/tuned_parts.hpp"

namespace sinew::world {

uint32_t ticks_to_sleep(const Instance& instance, size_t region) noexcept {
  constexpr float kNever = 1e9f;  // half a year; what hardly swings has more than an integer holds
  const float w1_tick = first_rad_per_s(instance, region) * static_cast<float>(instance.asset->tick_s);
  return static_cast<uint32_t>(
      std::min(kNever, std::ceil(std::numbers::pi_v<float> / std::min(w1_tick, 1.0f))));
}

bool is_asleep(const Instance& instance, size_t region) noexcept {
  return !instance.level->leaves_out(region) &&
         (instance.tissue.quiet_ticks[region] >= ticks_to_sleep(instance, region) ||
          region_is_off(instance, region));
}

uint32_t regions_asleep(const Instance& instance) noexcept {
  uint32_t count = 0;
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) count += is_asleep(instance, r);
  return count;
}

uint32_t rods_asleep(const Instance& instance) noexcept {
  const bool asleep = instance.state->rods.quiet_ticks >= kRodsQuietTicks || rods_are_off(instance);
  return asleep ? instance.asset->rods.rod_count : 0;
}

}  // namespace sinew::world

// tick.hpp  An instance's share of a step: its ticks, then publishing. Runs on any thread; touches this
// instance only.
#pragma once
#include "sinew/types.hpp"
#include "world/instance.hpp"

namespace sinew::world {

struct TickContext {
  ClockHook clock;
  uint64_t deadline_ns = UINT64_MAX;  // a simulated task that would begin later is cut: extrapolated instead
  float teleport_distance_m = 2;
  float sleep_tolerance = 0;  // WorldDef; 0: regions never sleep
};

// instance.plan says what is to be done.
void step_instance(Instance& instance, const TickContext& context) noexcept;

}  // namespace sinew::world

// tick.hpp  An instance's share of a step: its ticks, then publishing. Runs on any thread; touches this
// instance only.
#pragma once
#include "character/instance.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

struct TickContext {
  ClockHook clock;
  ProfilerHook profiler;
  // What would not be done by then is not begun: a cheaper tier that would, else the instance is carried on,
  // else it is shown as it was.
  uint64_t deadline_ns = UINT64_MAX;
  float tasks_us = 0;      // from the step's start to there
  float behind_scale = 1;  // of TierDecision::behind_us: workers share it
  double frame_s = 0;      // what the world's step takes
  TeleportDef teleport = {};
};

// instance.plan says what is to be done.
void step_instance(Instance& instance, const TickContext& context, uint32_t slot = kNoInstance) noexcept;
// The same for one that is neither simulated nor displaced.
void step_idle(Instance& instance, const TickContext& context) noexcept;

}  // namespace sinew::world

// sleep.hpp  Regions at rest are left out of a tick's products.
//
// With w1 a region's lowest frequency, h a tick and s = sleep_tolerance x its radius, a length:
//   quiet   in a tick: each node's felt acceleration is within s w1^2 of what it was as the quiet began, and
//           its l moved by at most s w1 h: what swings at w1 or above swings by less than s
//   asleep  after half a swing of quiet ticks, pi / (w1 h), as long as the felt acceleration stays that near
// What the instance's level leaves out neither sleeps nor is awake.
// A sleeping region keeps l, theta, q, r and its network's states, with no velocity, and is carried and shown
// as ever. Its poses and drive are followed, so that the first tick in which it feels more is simulated like
// any other. What that costs: a swing of s, and the answer to a push of s w1^2, which is s if it lasts and
// s / (2 zeta) if it lasts at resonance (damping ratio zeta).
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// After a tick's drive, before its tissue: wakes what feels more than it did.
void watch_drive(Instance& instance) noexcept;
// After its tissue: counts quiet ticks; what falls asleep stops.
void watch_motion(Instance& instance) noexcept;

// f of a region's nodes (tissue/frames/node_drive.hpp), three numbers each, so many floats apart, and so many
// times as large.
struct FeltNodes {
  const float* first;
  size_t stride;
  float times = 1;
};
// Whether that would let a sleeping region sleep on.
bool feels_as_asleep(const Instance& instance, size_t region, const FeltNodes& felt) noexcept;

}  // namespace sinew::world

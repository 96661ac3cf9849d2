// rod_state.hpp  How an instance's rods are turned, held and shown.
#pragma once
#include <cstdint>
#include <memory>

#include "character/asset/asset.hpp"
#include "core/arena.hpp"
#include "rods/rod_batch.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

// Plain bytes, saved and restored as they are.
struct RodCounters {
  double anchor_m[3] = {};   // of the world, where rods' places count from: near, so that they stay exact
  uint32_t quiet_ticks = 0;  // character/rest/rod_sleep.hpp
  uint32_t recoveries = 0;
};

// [slots][4]: how a segment is turned against its rest, x y z w along its own axes.
struct RodState {
  RodWarmStart start = RodWarmStart::kAsBaked;
  std::unique_ptr<rods::RodBatch[]> batches;  // their state is saved beside the run of bytes below

  // State. As u, shown and tail are for tissue:
  float *turn = nullptr, *shown[2] = {}, *tail = nullptr;
  float* tail_velocity = nullptr;                    // [slots][3]: rotation vector a tick
  double *asleep = nullptr, *hold_asleep = nullptr;  // rest and hold when their quiet began
  // Of the last two ticks, newest first: [slots][4] segments' orientations in the world at rest, and where
  // rods are held, [rods][3] then [held ends][3], from anchor_m.
  double *rest[2] = {}, *hold[2] = {};

  // Scratch of a step.
  double *rest_now = nullptr, *hold_now = nullptr;    // as rest and hold, at the end of the step
  float *orientations = nullptr, *between = nullptr;  // [slots][4], there: in the world, and as shown
  float* velocity = nullptr;    // [slots][6], of rods that are carried: beside the pose's, along own axes
  double* end[2] = {};          // [slots][3] where segments end, as they are taken along
  bool begin_as_shown = false;  // in this tick: they are taken to where they are shown before they go on

  // Published by a step.
  bool are_shown = false;            // published joints are not the pose's
  const float* published = nullptr;  // shown[0] or between
  Matrix34* motion = nullptr;        // [slots]: how rods move the pose's bones, in the character's space
  Matrix34* joints = nullptr;        // [joints], where there are rods: the pose's, moved by them
};

void lay_out_state(const Asset& asset, core::Arena& arena, RodState& to) noexcept;
void lay_out_scratch(const Asset& asset, core::Arena& arena, RodState& to) noexcept;

}  // namespace sinew::world

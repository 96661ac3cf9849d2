// contact_state.hpp  What an instance asks about contacts, and what it was told.
#pragma once
#include <cstdint>
#include <memory>

#include "character/asset/asset.hpp"
#include "character/contacts/scaled_source.hpp"
#include "character/rods/rod_source.hpp"
#include "core/arena.hpp"
#include "rods/contacts/collider.hpp"
#include "sinew/contact_source.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

// In one question; as many hits of a contact source as of the own body.
inline constexpr uint32_t kProbesAtOnce = 128, kHitsAtOnce = 2 * kProbesAtOnce;

// One vertex against one half-space in a tick.
struct Touch {
  uint32_t region, node, vertex;  // of the character; in its surface's patches
  float normal[3] = {};           // world, out of what is touched
  float gap_m = 0;                // where nothing presses
  float place_m[3] = {};          // is there, from the tick's root
  float start_m[3] = {};          // where it was shown a tick ago, from that tick's root
};

// Of soft parts only where there is something to touch: without a source and soft parts that touch the body,
// the arrays have no memory.
struct ContactState {
  ContactDef def;                                      // own_body and surface: only where there are such
  std::unique_ptr<rods::RodCollider[]> rod_colliders;  // [batches], saved with them; null: rods touch nothing
  std::unique_ptr<ScaledSource> scaled[2];             // def.source and surface; null: there is none
  std::unique_ptr<RodSource> rod_source;               // what rods ask; null: def.source at most

  // State.
  // Ends of capsules, of the last two ticks, newest first, [proxies][2][3] from RodCounters::anchor_m; null:
  // it does not touch its body.
  double* proxy_ends[2] = {};
  // Of soft parts that may touch something, else null: how vertices are pushed, laid out and along axes as
  // `carried`, and whether any of a region's is.
  float* pushes = nullptr;
  uint32_t* pushed = nullptr;  // [regions]
  // Of the last two ticks, newest first, where something may be touched: [joints][12], and the root's turn.
  float *tick_skin[2] = {}, *tick_turn[2] = {};

  // Scratch of a step.
  ContactProbe* probes = nullptr;  // [kProbesAtOnce]
  ContactHit* hits = nullptr;      // [kHitsAtOnce], and as many of the own body where it is touched
  Touch* touches = nullptr;        // [2 carried vertices]
  uint32_t touch_count = 0;
  float* flesh = nullptr;             // [nodes][3]: displacement along the axes of the flesh
  float touched_moves_m = 0;          // in the tick, at most
  uint32_t* deepest = nullptr;        // [nodes]: of touches
  uint8_t* touched = nullptr;         // [carried vertices]
  uint8_t* carries_pushes = nullptr;  // [regions]: `carried` has pushes in it
  // proxy_ends a tick ago, whoever sleeps; null: soft parts do not touch them.
  double* proxy_before = nullptr;
};

// By `to.def`.
bool touches_own_body(const Asset& asset, const ContactDef& contacts) noexcept;
bool soft_parts_touch(const Asset& asset, const ContactDef& contacts) noexcept;
void lay_out_state(const Asset& asset, core::Arena& arena, ContactState& to) noexcept;
void lay_out_scratch(const Asset& asset, core::Arena& arena, ContactState& to) noexcept;

}  // namespace sinew::world

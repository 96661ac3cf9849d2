// rod_rig.hpp  How a character's rods lie on its skeleton; shared by its instances.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "pack/format.hpp"
#include "pack/pack_view.hpp"
#include "rods/strand.hpp"
#include "sinew/status.hpp"

namespace sinew::world {

// A segment of a rod. Slots go rod after rod; each rod's first one is its *holder*, which the pack does not
// have: as long as the first bone's segment, straight behind it and fixed to the bone that the rod hangs on.
// A rod whose end is held has another one, its last: as long as the last bone's segment, straight on and
// fixed to the joint that holds it.
struct RodSlot {
  double offset_xyzw[4];  // the segment's axes in those of `joint`, at rest
  double bind_xyzw[4];    // the segment's axes in the character's, bind pose
  uint32_t joint;         // whose rotation it follows at rest: the bone's, for a link the one it hangs on
  uint32_t parent;        // slot; a holder's is itself
  uint32_t bone;          // its own joint; kNoIndex for holders and links
  float length_m, radius_m, mass_kg, damping_s;
};

// Rods of one shape and start are strands of one batch.
struct RodSeat {
  uint32_t batch, strand;
  uint32_t first_slot, slot_count;
  float turn_limit_rad;  // pack::RodRecord
  uint32_t end_hold;     // in RodRig::ends; kNoIndex: its end is free
  bool learned;          // pack::RodRecord::start; alike in a batch
  // Slots from first_slot + 1 on that are the pack's segments.
  uint32_t segment_count() const noexcept { return slot_count - 1 - (end_hold != pack::kNoIndex); }
};

// Where a rod's end is held: a place in its joint's own space.
struct RodEnd {
  double place_m[3];
  uint32_t joint;
};

struct RodRig {
  std::unique_ptr<RodSlot[]> slot_memory;
  std::unique_ptr<RodSeat[]> seat_memory;
  std::unique_ptr<uint32_t[]> joint_slots;  // a joint's carrier; kNoIndex: no rod moves it
  std::unique_ptr<RodEnd[]> end_memory;
  uint32_t slot_count = 0, rod_count = 0, batch_count = 0, end_count = 0;

  std::span<const RodSlot> slots() const noexcept { return {slot_memory.get(), slot_count}; }
  std::span<const RodSeat> seats() const noexcept { return {seat_memory.get(), rod_count}; }
  std::span<const RodEnd> ends() const noexcept { return {end_memory.get(), end_count}; }
  // Places where rods are held: each rod's beginning, then the ends.
  uint32_t hold_count() const noexcept { return rod_count + end_count; }
};

// Of a checked pack. kOutOfCapacity when memory is short.
Status make_rod_rig(const pack::PackView& pack, RodRig* out) noexcept;

// A rod's segments in the bind pose, the holder first and one of its end last; out has room for its slots.
void define_strand(const pack::PackView& pack, const RodRig& rig, uint32_t rod,
                   std::span<rods::SegmentDef> out) noexcept;

}  // namespace sinew::world

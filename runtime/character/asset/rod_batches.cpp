// rod_batches.cpp  An instance's rods as batches: one for each shape of its asset's rods.
#include "character/asset/rod_batches.hpp"

#include <new>
#include <utility>

#include "core/status.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::world {
namespace {

// Gravity comes as a force, a rod's own; teleports are the world's (character/rods/rod_motion.hpp).
rods::RodSettings settings_of(const Asset& asset, bool baked_learned, const InstanceDef& def) noexcept {
  const bool learned =
      def.rod_start == RodWarmStart::kAsBaked ? baked_learned : def.rod_start == RodWarmStart::kLearned;
  rods::RodSettings settings{.start = learned ? rods::RodStart::kLearned : rods::RodStart::kContinued};
  for (float& g : settings.gravity_m_s2) g = 0;
  settings.teleport_lengths = 1e30f;
  settings.max_iterations = def.max_rod_iterations;
  settings.report_residual = def.report_rod_residual;
  if (learned) settings.network = &asset.rod_network;
  return settings;
}

// What is needed while batches are made.
struct Definitions {
  std::unique_ptr<rods::SegmentDef[]> segments;  // [slots]
  std::unique_ptr<rods::StrandDef[]> strands;    // [rods]
};

Status no_memory() noexcept {
  return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for its rods");
}

}  // namespace

Status check_rod_start(const Asset& asset, const InstanceDef& def) noexcept {
  if (def.rod_start > RodWarmStart::kLearned)
    return core::make_status(StatusCode::kInvalidArgument, "create_instance: rod_start %u is not known",
                             static_cast<uint32_t>(def.rod_start));
  if (def.max_rod_iterations < 1 || def.max_rod_iterations > 1000)
    return core::make_status(StatusCode::kInvalidArgument,
                             "create_instance: max_rod_iterations is %u; give 1 to 1000",
                             def.max_rod_iterations);
  if (def.rod_start == RodWarmStart::kLearned && !asset.rod_network.record)
    return core::make_status(StatusCode::kInvalidArgument,
                             "create_instance: rod_start is kLearned, and the asset has no network for rods; "
                             "bake it with sinew-bake character --rods");
  return {};
}

Status make_rod_batches(const Asset& asset, const InstanceDef& def,
                        std::unique_ptr<rods::RodBatch[]>* out) noexcept {
  const RodRig& rig = asset.rods;
  if (rig.rod_count == 0) return {};
  std::unique_ptr<rods::RodBatch[]> made(new (std::nothrow) rods::RodBatch[rig.batch_count]);
  Definitions defs{std::unique_ptr<rods::SegmentDef[]>(new (std::nothrow) rods::SegmentDef[rig.slot_count]),
                   std::unique_ptr<rods::StrandDef[]>(new (std::nothrow) rods::StrandDef[rig.rod_count])};
  if (!made || !defs.segments || !defs.strands) return no_memory();
  for (uint32_t batch = 0; batch < rig.batch_count; ++batch) {
    uint32_t strands = 0;
    bool learned = false;
    for (uint32_t rod = 0; rod < rig.rod_count; ++rod) {
      const RodSeat& seat = rig.seats()[rod];
      if (seat.batch != batch) continue;
      const std::span<rods::SegmentDef> segments(defs.segments.get() + seat.first_slot, seat.slot_count);
      define_strand(asset.pack, rig, rod, segments);
      defs.strands[strands++] = {segments};
      learned = seat.learned;
    }
    const Status status = rods::RodBatch::create(std::span(defs.strands.get(), strands),
                                                 settings_of(asset, learned, def), &made[batch]);
    if (!status.ok()) return core::make_status(status.code, "create_instance: rods: %s", status.message);
  }
  *out = std::move(made);
  return {};
}

size_t rod_batch_bytes(const Asset& asset) noexcept {
  const RodRig& rig = asset.rods;
  size_t bytes = 0;
  for (uint32_t batch = 0; batch < rig.batch_count; ++batch) {
    uint32_t strands = 0, segments = 0;
    bool learned = false;
    for (const RodSeat& seat : rig.seats()) {
      if (seat.batch != batch) continue;
      ++strands;
      segments = seat.slot_count;
      learned = seat.learned;
    }
    bytes += sizeof(rods::RodBatch) +
             rods::RodBatch::memory_bytes(strands, segments, settings_of(asset, learned, {}));
  }
  return bytes;
}

}  // namespace sinew::world

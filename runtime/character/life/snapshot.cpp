// snapshot.cpp  An instance's state as bytes, for rollback.
#include "character/life/snapshot.hpp"

#include <cmath>
#include <cstring>

#include "character/motion/pose_bound.hpp"
#include "character/output/publish.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/parameters/tuning.hpp"
#include "character/tier_limit.hpp"
#include "core/floating_point.hpp"
#include "core/hash.hpp"
#include "core/status.hpp"

namespace sinew::world {
namespace {

using core::make_status;

constexpr uint64_t kMagic = 0x31544154534e5753;  // "SWNSTAT1", little-endian
// Of InstanceState, the arrays after it and the rods' batches. 4: which regions sleep, and what they felt
// when they fell asleep. 5: rods. 6: how vertices are pushed, and contacts' forces.
// 7: who is hidden. 8: what the scheduler goes by, what is gone on by between ticks that are simulated whole.
// 9: who is dormant.
// 10: the level of control graphs, and what its last change left. 11: the same in another order. 12: how
// contacts' forces changed. 13: the update rate, and who was looked at last. 14: what was missed, and
// whose tail rides. 15: regions that a change of level had again. 16: blends of any length.
// 18: how long a tail fades. 19: what the corrections of a network may spend.
// 20: flesh beyond its limit swings on in l. 21: no update rates, no springs. 22: teleports,
// spaces, scales of time and size, a pose more. 23: what the last tick added, time without poses. 24: where
// emulated nodes were. 25: no longer. 26: what an engine changed of its parts, and what it feels of the
// world. 27: the best tier it may get. 28: parts in structs of their own.
constexpr uint32_t kVersion = 28;

struct Header {
  uint64_t magic, fingerprint, payload_bytes, checksum;
  uint32_t version, contacts;
};
static_assert(sizeof(Header) == 40);

// What of an instance may touch, and what its rods start from: so which arrays it has.
uint32_t contacts_of(const Instance& instance) noexcept {
  const ContactDef& def = instance.contacts.def;
  const bool source = def.source != nullptr, rods = instance.contacts.rod_colliders != nullptr;
  return uint32_t{source} | uint32_t{rods} << 1 | uint32_t{def.own_body} << 2 |
         uint32_t{def.surface != nullptr} << 3 | uint32_t{source && def.rods} << 4 |
         static_cast<uint32_t>(instance.rods.start) << 5;
}

Header header_of(const Instance& instance, std::span<const std::byte> payload) noexcept {
  return {kMagic,   instance.asset->fingerprint, payload.size(), core::hash64(payload),
          kVersion, contacts_of(instance)};
}

void save_rods(const Instance& instance, std::byte* out) noexcept {
  for (uint32_t b = 0; b < instance.asset->rods.batch_count; ++b) {
    instance.rods.batches[b].save_state(out);
    out += instance.rods.batches[b].state_bytes();
    if (!instance.contacts.rod_colliders) continue;
    instance.contacts.rod_colliders[b].save_state(out);
    out += instance.contacts.rod_colliders[b].state_bytes();
  }
}

void restore_rods(Instance& instance, const std::byte* from) noexcept {
  for (uint32_t b = 0; b < instance.asset->rods.batch_count; ++b) {
    instance.rods.batches[b].restore_state(from);
    from += instance.rods.batches[b].state_bytes();
    if (!instance.contacts.rod_colliders) continue;
    instance.contacts.rod_colliders[b].restore_state(from);
    from += instance.contacts.rod_colliders[b].state_bytes();
  }
}

size_t payload_bytes(const Instance& instance) noexcept {
  size_t bytes = instance.state_bytes;
  for (uint32_t b = 0; b < instance.asset->rods.batch_count; ++b) {
    bytes += instance.rods.batches[b].state_bytes();
    if (instance.contacts.rod_colliders) bytes += instance.contacts.rod_colliders[b].state_bytes();
  }
  return bytes;
}

Status corrupt(const char* why) noexcept {
  return make_status(StatusCode::kCorrupt, "restore_state: %s", why);
}

}  // namespace

size_t snapshot_bytes(const Instance& instance) noexcept { return sizeof(Header) + payload_bytes(instance); }

Status save(const Instance& instance, std::span<std::byte> out) noexcept {
  if (out.size() < snapshot_bytes(instance)) {
    return make_status(StatusCode::kInvalidArgument, "save_state: %zu bytes given, %zu needed (state_bytes)",
                       out.size(), snapshot_bytes(instance));
  }
  const std::span<std::byte> payload = out.subspan(sizeof(Header), payload_bytes(instance));
  std::memcpy(payload.data(), instance.state, instance.state_bytes);
  save_rods(instance, payload.data() + instance.state_bytes);
  const Header header = header_of(instance, payload);
  std::memcpy(out.data(), &header, sizeof header);
  return {};
}

Status restore(Instance& instance, std::span<const std::byte> bytes) noexcept {
  if (bytes.size() < sizeof(Header)) return corrupt("fewer bytes than state_bytes; cut");
  Header given;
  std::memcpy(&given, bytes.data(), sizeof given);
  if (given.magic != kMagic) return corrupt("not a snapshot of an instance");
  if (given.version != kVersion) return corrupt("saved by another version of the library");
  if (given.fingerprint != instance.asset->fingerprint)
    return corrupt("saved from an instance of another asset");
  if (given.contacts != contacts_of(instance))
    return corrupt(
        "saved from an instance with another ContactDef (a source or none, rods, own_body, surface) or "
        "rod_start");
  if (bytes.size() < snapshot_bytes(instance)) return corrupt("fewer bytes than state_bytes; cut");
  const std::span<const std::byte> payload = bytes.subspan(sizeof given, payload_bytes(instance));
  if (given.payload_bytes != payload.size() || !core::has_checksum(payload, given.checksum)) {
    return corrupt("the bytes changed since they were saved");
  }
  InstanceState state;
  std::memcpy(&state, payload.data(), sizeof state);
  if (state.level >= instance.asset->level_count || !pack::is_tier(static_cast<uint32_t>(state.tier)) ||
      !pack::is_tier(static_cast<uint32_t>(state.left_tier)) || !may_limit(state.tier_limit))
    return corrupt("names a control graph or a tier that there is not");
  if (instance.transition.seam == nullptr && state.transition.seam_ticks < kBlendInTicks)
    return corrupt("is amid a change of control graphs, of which there is one");
  if (!std::isfinite(state.remainder_s) || !std::isfinite(state.poses.without_pose_s) ||
      !std::isfinite(state.poses.time_scale))
    return corrupt("counts time that is not finite");
  const bool was_tuned = tunes_parts(instance);
  std::memcpy(instance.state, payload.data(), instance.state_bytes);
  restore_rods(instance, payload.data() + instance.state_bytes);
  point_to_state(instance);
  if (was_tuned || tunes_parts(instance)) retune_all(instance);
  instance.rods.begin_as_shown = false;
  instance.told = {};
  instance.marks.displaced =
      false;  // else what was shown here before would be taken out of the state as it ends
  bound_pose(instance);
  const core::FloatingPointScope mode;  // as in a step: the same bits are shown
  publish(instance);
  restore_rods(instance, payload.data() + instance.state_bytes);  // what is shown between ticks drives them
  return {};
}

}  // namespace sinew::world

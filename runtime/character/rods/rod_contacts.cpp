// rod_contacts.cpp  see rod_contacts.hpp.
#include "character/rods/rod_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cfloat>
#include <new>
#include <utility>

#include "character/asset/affords_surface.hpp"
#include "character/rods/own_body.hpp"
#include "core/check_hit.hpp"
#include "core/status.hpp"
#include "math/rotation.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3d;

// Of all together: one segment in a fold has up to eight.
constexpr uint32_t kHitsASegment = 4, kMostHits = 1u << 20;

bool asks(const ContactState& contacts) noexcept { return contacts.def.source && contacts.def.rods; }

// The most they ask, on whatever tier.
uint32_t source_count(const ContactState& contacts) noexcept {
  return uint32_t{asks(contacts)} + uint32_t{contacts.def.surface != nullptr};
}

// What a change of tier leaves inside is brought out by degrees: of the character's height a second. Strands
// are pushed apart some times as fast.
float push_out_m_s(const Instance& instance) noexcept {
  constexpr float kHeights = 0.02f;
  if (!instance.contacts.def.surface) return rods::ColliderSettings{}.largest_push_out_m_s;
  return std::max(kHeights * instance.level->pack.character->height_m, FLT_MIN);
}

rods::ColliderSettings settings_of(const Instance& instance, const rods::RodBatch& batch) noexcept {
  const uint64_t segments = uint64_t{batch.strand_count()} * batch.segment_count();
  const uint64_t wanted = source_count(instance.contacts) * kHitsASegment * segments;
  const auto hits = static_cast<uint32_t>(std::min<uint64_t>(wanted, kMostHits));
  return {.rods_collide = false,
          .largest_push_out_m_s = push_out_m_s(instance),
          .contact_capacity = source_count(instance.contacts) > 1 ? std::max(hits, 64u) : 0,
          .obstacle_capacity = proxy_count(instance),
          .point_capacity = 0,
          .source_capacity = hits};
}

Status make_rod_source(ContactState& contacts) noexcept {
  if (!contacts.def.surface) return {};
  ContactSource* source = asks(contacts) ? contacts.def.source : nullptr;
  contacts.rod_source.reset(new (std::nothrow) RodSource(source, contacts.def.surface));
  if (contacts.rod_source) return {};
  return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for its rods");
}

// Where the tier affords it the surface and what else there is, else that and the own body.
void choose_touched(Instance& instance, rods::RodCollider& collider) noexcept {
  const bool on_surface = touches_surface(instance);
  if (on_surface)
    (void)collider.set_capsules({});
  else if (proxy_count(instance) > 0)
    set_proxies(instance, collider);
  if (!instance.contacts.rod_source) return;
  ContactSource* source = asks(instance.contacts) ? instance.contacts.def.source : nullptr;
  (void)collider.set_source(on_surface ? instance.contacts.rod_source.get() : source,
                            instance.contacts.def.owner);
}

Eigen::AlignedBox3d box_of_rods(const Instance& instance) noexcept {
  Eigen::AlignedBox3d box;
  for (const RodSeat& seat : instance.asset->rods.seats()) {
    for (uint32_t k = 1; k <= seat.segment_count(); ++k) {
      const RodSlot& slot = instance.asset->rods.slots()[seat.first_slot + k];
      const rods::SegmentPose pose = instance.rods.batches[seat.batch].pose(seat.strand, k);
      const Vector3d middle = Eigen::Map<const Vector3d>(pose.position_m);
      const double reach = double{slot.length_m} / 2 + double{slot.radius_m};
      box.extend(middle + Vector3d::Constant(reach));
      box.extend(middle - Vector3d::Constant(reach));
    }
  }
  return box;
}

}  // namespace

bool touches_surface(const Instance& instance) noexcept {
  return instance.contacts.def.surface && affords_surface(instance.state->tier, instance.state->level);
}

Status make_rod_colliders(Instance& instance) noexcept {
  const uint32_t count = instance.asset->rods.batch_count;
  if ((source_count(instance.contacts) == 0 && proxy_count(instance) == 0) || count == 0) return {};
  if (Status status = make_rod_source(instance.contacts); !status.ok()) return status;
  std::unique_ptr<rods::RodCollider[]> made(new (std::nothrow) rods::RodCollider[count]);
  if (!made) return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for its rods");
  for (uint32_t b = 0; b < count; ++b) {
    const rods::RodBatch& batch = instance.rods.batches[b];
    const Status status = rods::RodCollider::create(batch, settings_of(instance, batch), &made[b]);
    if (!status.ok()) return core::make_status(status.code, "create_instance: rods: %s", status.message);
    if (asks(instance.contacts))
      (void)made[b].set_source(instance.contacts.def.source, instance.contacts.def.owner);
    pass_proxies(instance, b, made[b]);
  }
  instance.contacts.rod_colliders = std::move(made);
  return {};
}

rods::RodCollider* rod_collider(Instance& instance, uint32_t batch) noexcept {
  if (!instance.contacts.rod_colliders) return nullptr;
  instance.contacts.rod_colliders[batch].set_origin(instance.state->rods.anchor_m);
  choose_touched(instance, instance.contacts.rod_colliders[batch]);
  return &instance.contacts.rod_colliders[batch];
}

void forget_rod_contacts(Instance& instance) noexcept {
  if (!instance.contacts.rod_colliders) return;
  for (uint32_t b = 0; b < instance.asset->rods.batch_count; ++b)
    instance.contacts.rod_colliders[b].forget_forces();
}

namespace {

ContactProbe probe_of(const Instance& instance, const RodSeat& seat, uint32_t k) noexcept {
  const RodSlot& slot = instance.asset->rods.slots()[seat.first_slot + k];
  const rods::SegmentPose pose = instance.rods.batches[seat.batch].pose(seat.strand, k);
  const Vector3d middle =
      Eigen::Map<const Vector3d>(pose.position_m) + Eigen::Map<const Vector3d>(instance.state->rods.anchor_m);
  const Vector3d half = quaternion(pose.orientation) * Vector3d(0, 0, double{slot.length_m} / 2);
  ContactProbe probe{.radius_m = slot.radius_m, .owner = instance.contacts.def.owner};
  for (double(*ends)[3] : {probe.start_m, probe.end_m}) {
    std::copy_n(Vector3d(middle - half).data(), 3, ends[0]);
    std::copy_n(Vector3d(middle + half).data(), 3, ends[1]);
  }
  return probe;
}

// A rod at a time: what is near one of its segments is not far from the next.
bool surface_is_near(const Instance& instance, const RodSeat& seat) noexcept {
  constexpr uint32_t kAtOnce = 32;
  ContactProbe probes[kAtOnce];
  ContactHit hit;
  const auto tick_s = static_cast<float>(instance.asset->tick_s);
  for (uint32_t first = 1; first <= seat.segment_count(); first += kAtOnce) {
    const uint32_t count = std::min(kAtOnce, seat.segment_count() + 1 - first);
    for (uint32_t i = 0; i < count; ++i) probes[i] = probe_of(instance, seat, first + i);
    if (instance.contacts.def.surface->find({probes, count}, tick_s, {&hit, 1}) > 0) return true;
  }
  return false;
}

bool surface_is_near(const Instance& instance) noexcept {
  const std::span<const RodSeat> seats = instance.asset->rods.seats();
  return std::any_of(seats.begin(), seats.end(),
                     [&](const RodSeat& seat) { return surface_is_near(instance, seat); });
}

}  // namespace

bool something_is_near_rods(Instance& instance) noexcept {
  if (!instance.contacts.rod_colliders) return false;
  if (proxies_move(instance)) return true;
  if (touches_surface(instance) && surface_is_near(instance)) return true;
  if (!asks(instance.contacts)) return false;
  const Eigen::AlignedBox3d box = box_of_rods(instance);
  const Vector3d middle = box.center() + Eigen::Map<const Vector3d>(instance.state->rods.anchor_m);
  ContactProbe& probe = instance.contacts.probes[0];
  for (double* end : {probe.start_m[0], probe.start_m[1], probe.end_m[0], probe.end_m[1]})
    std::copy_n(middle.data(), 3, end);
  probe.radius_m = static_cast<float>(box.diagonal().norm() / 2);
  probe.owner = instance.contacts.def.owner;
  const auto tick_s = static_cast<float>(instance.asset->tick_s);
  return instance.contacts.def.source->find({&probe, 1}, tick_s, {instance.contacts.hits, 1}) > 0;
}

}  // namespace sinew::world

// rod_contacts.cpp  see rod_contacts.hpp.
#include "world/rod_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <new>
#include <utility>

#include "core/check_hit.hpp"
#include "core/status.hpp"
#include "world/own_body.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3d;

// Of all together: one segment in a fold has up to eight.
constexpr uint32_t kHitsASegment = 4, kMostHits = 1u << 20;

bool asks(const Instance& instance) noexcept { return instance.contacts.source && instance.contacts.rods; }

rods::ColliderSettings settings_of(const Instance& instance, const rods::RodBatch& batch) noexcept {
  const uint64_t segments = uint64_t{batch.strand_count()} * batch.segment_count();
  const auto hits = static_cast<uint32_t>(std::min<uint64_t>(kHitsASegment * segments, kMostHits));
  return {.rods_collide = false,
          .obstacle_capacity = proxy_count(instance),
          .point_capacity = 0,
          .source_capacity = asks(instance) ? hits : 0};
}

Eigen::AlignedBox3d box_of_rods(const Instance& instance) noexcept {
  Eigen::AlignedBox3d box;
  for (const RodSeat& seat : instance.asset->rods.seats()) {
    for (uint32_t k = 1; k < seat.slot_count; ++k) {
      const RodSlot& slot = instance.asset->rods.slots()[seat.first_slot + k];
      const rods::SegmentPose pose = instance.rod_batches[seat.batch].pose(seat.strand, k);
      const Vector3d middle = Eigen::Map<const Vector3d>(pose.position_m);
      const double reach = double{slot.length_m} / 2 + double{slot.radius_m};
      box.extend(middle + Vector3d::Constant(reach));
      box.extend(middle - Vector3d::Constant(reach));
    }
  }
  return box;
}

}  // namespace

Status make_rod_colliders(Instance& instance) noexcept {
  const uint32_t count = instance.asset->rods.batch_count;
  if ((!asks(instance) && proxy_count(instance) == 0) || count == 0) return {};
  std::unique_ptr<rods::RodCollider[]> made(new (std::nothrow) rods::RodCollider[count]);
  if (!made) return core::make_status(StatusCode::kOutOfCapacity, "create_instance: no memory for its rods");
  for (uint32_t b = 0; b < count; ++b) {
    const rods::RodBatch& batch = instance.rod_batches[b];
    const Status status = rods::RodCollider::create(batch, settings_of(instance, batch), &made[b]);
    if (!status.ok()) return core::make_status(status.code, "create_instance: rods: %s", status.message);
    if (asks(instance)) (void)made[b].set_source(instance.contacts.source, instance.contacts.owner);
    pass_proxies(instance, b, made[b]);
  }
  instance.rod_colliders = std::move(made);
  return {};
}

rods::RodCollider* rod_collider(Instance& instance, uint32_t batch) noexcept {
  if (!instance.rod_colliders) return nullptr;
  instance.rod_colliders[batch].set_origin(instance.state->rod_anchor_m);
  if (proxy_count(instance) > 0) set_proxies(instance, instance.rod_colliders[batch]);
  return &instance.rod_colliders[batch];
}

void forget_rod_contacts(Instance& instance) noexcept {
  if (!instance.rod_colliders) return;
  for (uint32_t b = 0; b < instance.asset->rods.batch_count; ++b) instance.rod_colliders[b].forget_forces();
}

bool something_is_near_rods(Instance& instance) noexcept {
  if (!instance.rod_colliders) return false;
  if (proxies_move(instance)) return true;
  if (!asks(instance)) return false;
  const Eigen::AlignedBox3d box = box_of_rods(instance);
  const Vector3d middle = box.center() + Eigen::Map<const Vector3d>(instance.state->rod_anchor_m);
  ContactProbe& probe = instance.probes[0];
  for (double* end : {probe.start_m[0], probe.start_m[1], probe.end_m[0], probe.end_m[1]})
    std::copy_n(middle.data(), 3, end);
  probe.radius_m = static_cast<float>(box.diagonal().norm() / 2);
  probe.owner = instance.contacts.owner;
  const auto tick_s = static_cast<float>(instance.asset->tick_s);
  return instance.contacts.source->find({&probe, 1}, tick_s, {instance.hits, 1}) > 0;
}

}  // namespace sinew::world

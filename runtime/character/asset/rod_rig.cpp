// rod_rig.cpp  How a character's rods lie on its skeleton.
#include "character/asset/rod_rig.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <new>
#include <numbers>

#include "character/motion/pose.hpp"
#include "core/status.hpp"
#include "math/turn_between.hpp"
#include "rods/section.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using pack::kNoIndex;

// About how long a torn seam takes to close: within a tick it would throw the rod.
constexpr float kSeamDamping_s = 0.05f;

Vector3d vector(const float (&v)[3]) noexcept { return Eigen::Map<const Eigen::Vector3f>(v).cast<double>(); }

std::span<const pack::RodSegmentRecord> segments_of(const pack::PackView& pack, uint32_t rod) noexcept {
  return pack.rod_segments.subspan(pack.rods[rod].first_segment, pack.rods[rod].segment_count);
}

// Own axes to the character's: z along the segment, by the shortest way from the parent's. From a common
// start neighbours would be rolled against each other, where that start points away from them by half a turn.
Quaterniond axes_of(const pack::RodSegmentRecord& segment, const Quaterniond& parent) noexcept {
  const Vector3d along = vector(segment.end_m) - vector(segment.begin_m);
  return (core::turn_between(parent * Vector3d::UnitZ(), along) * parent).normalized();
}

rods::SegmentDef define_segment(const pack::RodSegmentRecord& record) noexcept {
  const Vector3d begin = vector(record.begin_m), end = vector(record.end_m), middle = (begin + end) / 2;
  rods::SegmentDef s;
  std::copy_n(middle.data(), 3, s.position_m);
  s.length_m = static_cast<float>((end - begin).norm());
  s.radius_m = record.radius_m;
  s.density_kg_m3 = record.density_kg_m3;
  s.young_modulus_pa = record.young_modulus_pa;
  s.torsion_modulus_pa = record.torsion_modulus_pa;
  s.damping_s = record.damping_s;
  s.drag_per_s = record.drag_per_s;
  s.parent = record.parent == kNoIndex ? 0 : record.parent + 1;
  return s;
}

bool fit_together(const pack::PackView& pack, uint32_t a, uint32_t b) noexcept {
  const auto one = segments_of(pack, a), other = segments_of(pack, b);
  if ((pack.rods[a].end_holder != 0) != (pack.rods[b].end_holder != 0)) return false;
  if (pack.rods[a].start != pack.rods[b].start) return false;
  return std::ranges::equal(one, other, {}, &pack::RodSegmentRecord::parent, &pack::RodSegmentRecord::parent);
}

// The joint whose rotation a segment follows at rest.
uint32_t joint_of(const pack::PackView& pack, uint32_t rod, const pack::RodSegmentRecord& segment) noexcept {
  if (segment.joint != kNoIndex) return segment.joint;
  return segments_of(pack, rod)[segment.parent].joint;  // a link hangs on a bone
}

RodSlot make_slot(const Matrix34& bind, const Quaterniond& axes) noexcept {
  RodSlot slot{};
  Quaterniond joint;
  joint_rotation(bind, joint.coeffs().data());
  Eigen::Map<Eigen::Vector4d>(slot.offset_xyzw) = (joint.conjugate() * axes).normalized().coeffs();
  Eigen::Map<Eigen::Vector4d>(slot.bind_xyzw) = axes.coeffs();
  return slot;
}

Vector3d in_joint(const Matrix34& bind, const Vector3d& place) noexcept {
  const auto from =
      Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&bind.m[0][0]).cast<double>();
  return from.leftCols<3>().inverse() * (place - from.col(3));
}

// The slots before it are there.
void fill_end(const pack::PackView& pack, uint32_t rod, const Matrix34* bind, RodRig& rig) noexcept {
  const RodSeat& seat = rig.seat_memory[rod];
  const uint32_t own = seat.first_slot + seat.slot_count - 1, holder = pack.rods[rod].end_holder - 1;
  const RodSlot& last = rig.slot_memory[own - 1];
  RodSlot& slot = rig.slot_memory[own];
  slot = make_slot(bind[holder], Quaterniond(last.bind_xyzw));
  slot.joint = holder;
  slot.parent = own - 1;
  slot.bone = kNoIndex;
  slot.length_m = last.length_m;
  slot.radius_m = last.radius_m;
  slot.damping_s = kSeamDamping_s;
  RodEnd& end = rig.end_memory[seat.end_hold];
  end.joint = holder;
  Eigen::Map<Vector3d>(end.place_m) = in_joint(bind[holder], vector(segments_of(pack, rod).back().end_m));
}

void fill_slots(const pack::PackView& pack, uint32_t rod, const Matrix34* bind, RodRig& rig) noexcept {
  const uint32_t first = rig.seat_memory[rod].first_slot, attach = pack.rods[rod].attach;
  const auto segments = segments_of(pack, rod);
  RodSlot& holder = rig.slot_memory[first];
  holder = make_slot(bind[attach], axes_of(segments[0], Quaterniond::Identity()));
  holder.joint = attach;
  holder.parent = first;
  holder.bone = kNoIndex;
  holder.length_m = define_segment(segments[0]).length_m;
  for (uint32_t s = 0; s < segments.size(); ++s) {
    const uint32_t joint = joint_of(pack, rod, segments[s]);
    const rods::SegmentDef def = define_segment(segments[s]);
    RodSlot& slot = rig.slot_memory[first + 1 + s];
    const Quaterniond above(rig.slot_memory[first + def.parent].bind_xyzw);
    slot = make_slot(bind[joint], axes_of(segments[s], above));
    slot.joint = joint;
    slot.parent = first + def.parent;
    slot.bone = segments[s].joint;
    slot.radius_m = def.radius_m;
    slot.length_m = def.length_m;
    slot.damping_s = def.damping_s;
    slot.mass_kg = static_cast<float>(rods::segment_inertia(def).mass_kg);
  }
  if (pack.rods[rod].end_holder != 0) fill_end(pack, rod, bind, rig);
}

void fill_seats(const pack::PackView& pack, RodRig& rig) noexcept {
  uint32_t slot = 0, ends = 0;
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) {
    const bool end_held = pack.rods[rod].end_holder != 0;
    const uint32_t slots = pack.rods[rod].segment_count + 1 + end_held;
    RodSeat seat{.batch = rig.batch_count,
                 .strand = 0,
                 .first_slot = slot,
                 .slot_count = slots,
                 .turn_limit_rad = pack.rods[rod].turn_limit_rad,
                 .end_hold = end_held ? ends++ : kNoIndex,
                 .learned = pack.rods[rod].start != 0};
    for (uint32_t other = rod; other-- > 0;) {
      const RodSeat& known = rig.seat_memory[other];
      if (!fit_together(pack, rod, other)) continue;
      seat.batch = known.batch;
      seat.strand = known.strand + 1;
      break;
    }
    rig.batch_count += seat.batch == rig.batch_count;
    rig.seat_memory[rod] = seat;
    slot += slots;
  }
}

// The seam turns freely and closes but for a hundredth of the gap. It gives, because what is held twice may
// not reach.
void define_end(const Vector3d& place, std::span<rods::SegmentDef> out) noexcept {
  constexpr double kGive = 0.01, kTick_s = 1.0 / 60;
  constexpr float kHinge = 1e-4f;  // of the bones' moduli
  const rods::SegmentDef& last = out[out.size() - 2];
  rods::SegmentDef& end = out.back();
  end = last;
  end.parent = static_cast<uint32_t>(out.size()) - 2;
  end.fixed = true;
  for (int k = 0; k < 3; ++k) end.position_m[k] = 2 * place[k] - last.position_m[k];
  const double area = std::numbers::pi * double{last.radius_m} * double{last.radius_m};
  const double give_m_n = kGive * kTick_s * kTick_s / rods::segment_inertia(last).mass_kg;
  end.stretch_modulus_pa = static_cast<float>(double{last.length_m} / (give_m_n * area));
  end.young_modulus_pa *= kHinge;
  end.torsion_modulus_pa *= kHinge;
  end.damping_s = kSeamDamping_s;
}

void fill_joint_slots(const pack::PackView& pack, RodRig& rig) noexcept {
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) {
    const RodSeat& seat = rig.seat_memory[rod];
    for (uint32_t s = seat.first_slot + 1; s < seat.first_slot + seat.slot_count; ++s)
      if (rig.slot_memory[s].bone != kNoIndex) rig.joint_slots[rig.slot_memory[s].bone] = s;
  }
  for (size_t j = 0; j < pack.joints.size(); ++j) {
    const uint32_t parent = pack.joints[j].parent;
    if (rig.joint_slots[j] == kNoIndex && parent != kNoIndex) rig.joint_slots[j] = rig.joint_slots[parent];
  }
}

}  // namespace

Status make_rod_rig(const pack::PackView& pack, RodRig* out) noexcept {
  *out = {};
  if (pack.rods.empty()) return {};
  RodRig rig;
  rig.rod_count = static_cast<uint32_t>(pack.rods.size());
  for (const pack::RodRecord& rod : pack.rods) rig.end_count += rod.end_holder != 0;
  rig.slot_count = static_cast<uint32_t>(pack.rod_segments.size()) + rig.hold_count();
  rig.slot_memory.reset(new (std::nothrow) RodSlot[rig.slot_count]);
  rig.seat_memory.reset(new (std::nothrow) RodSeat[rig.rod_count]);
  rig.end_memory.reset(new (std::nothrow) RodEnd[rig.end_count]);
  rig.joint_slots.reset(new (std::nothrow) uint32_t[pack.joints.size()]);
  const std::unique_ptr<Matrix34[]> bind(new (std::nothrow) Matrix34[pack.joints.size()]);
  if (!rig.slot_memory || !rig.seat_memory || !rig.end_memory || !rig.joint_slots || !bind)
    return core::make_status(StatusCode::kOutOfCapacity, "load_asset: no memory for %u rods", rig.rod_count);
  std::fill_n(rig.joint_slots.get(), pack.joints.size(), kNoIndex);
  bind_pose(pack.joints, bind.get());
  fill_seats(pack, rig);
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) fill_slots(pack, rod, bind.get(), rig);
  fill_joint_slots(pack, rig);
  *out = std::move(rig);
  return {};
}

void define_strand(const pack::PackView& pack, const RodRig& rig, uint32_t rod,
                   std::span<rods::SegmentDef> out) noexcept {
  const auto segments = segments_of(pack, rod);
  const uint32_t first = rig.seats()[rod].first_slot + 1;
  for (size_t s = 0; s < segments.size(); ++s) {
    out[s + 1] = define_segment(segments[s]);
    std::copy_n(rig.slots()[first + s].bind_xyzw, 4, out[s + 1].orientation);
  }
  out[0] = out[1];
  out[0].parent = rods::kNoParent;
  out[0].fixed = true;
  const Vector3d axis = vector(segments[0].end_m) - vector(segments[0].begin_m);
  for (int k = 0; k < 3; ++k) out[0].position_m[k] -= axis[k];
  if (rig.seats()[rod].end_hold != kNoIndex) define_end(vector(segments.back().end_m), out);
}

}  // namespace sinew::world

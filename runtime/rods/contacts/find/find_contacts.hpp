// find_contacts.hpp  Which segments of a range of groups may touch something in the coming step.
//
// Each segment is a capsule on its way from where it is to where it would go without joints and contacts. A
// contact is made where that way, widened by a quarter of itself and half the radius, meets another. Its
// normal is that of the first touch on the way (conservative advancement), or of the start where it touches
// already: what is fast does not come out on the other side. Capsules side by side touch at both ends of
// where they overlap; at a plane a segment touches by its ends, and a joint's two ends are one.
//
// A segment that turns far within a step gets past a normal of its start with another part of it. So what was
// iterated to is looked at again: no axis enters the core of a sphere or capsule, half the sum of radii about
// its axis, nor, having begun there, comes nearer to that axis by more than a fifth,
// unless it lies about that axis; and a rod that is caught
// on something is not torn there, for rejoining it knows no obstacle. A strand that would goes only so far.
#pragma once
#include "rods/contacts/collider.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {

struct ContactFinder {
  RodCollider& to;
  const RodBatch& batch;
  double dt_s;

  // The iterate in scratch is the step's first.
  void find() const noexcept;
  // Of the iterate as the step's end: what share of its way each strand of the range goes before an axis
  // enters the core of a sphere or capsule, or before a strand that is near something is torn, into
  // progress_.ways; that core's own move in the step, into progress_.carries. A source, which is asked where
  // `ask`, stops axes at surfaces. Returns whether any is to be held; `again`: some were.
  bool find_holds(bool again) const noexcept;

 private:
  enum Kind : uint64_t { kPoint = 1, kPlane, kSphere, kCapsule, kRod, kHit };
  // What a segment touches: a segment, or an obstacle (segment is kNoSegment).
  struct Other {
    uint64_t kind, index;  // for its contacts' names
    uint32_t strand, segment;
    Sweep sweep;
    ObstacleMotion motion;
    Vector middle_m;  // that it turns about, at the step's end
    double friction, restitution;
    uint64_t name = mixed(mixed(0, kind), index);
  };
  static uint64_t mixed(uint64_t h, uint64_t value) {
    h = (h ^ value) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 29;
  }

  uint32_t first_strand() const { return to.places_.range.first_group * batch.width_; }
  uint32_t end_strand() const;
  size_t local(uint32_t strand, uint32_t segment) const {
    return size_t{to.seat(strand)} * batch.segment_count_ + segment;
  }
  uint32_t strand_of(uint32_t local) const {
    const uint32_t seat = local / batch.segment_count_;
    return to.places_.homes[batch.group_of(seat)] * batch.width_ + batch.lane_of(seat);
  }
  bool free(uint32_t strand, uint32_t segment) const;
  double mass_kg(uint32_t strand, uint32_t segment) const;
  Vector iterate3(uint32_t strand, uint32_t segment, uint32_t field) const;
  Axis axis(uint32_t strand, uint32_t segment, const Vector& move, const Vector& along) const;
  void add_sweep(uint32_t strand, uint32_t segment) const;
  const Sweep& sweep(uint32_t strand, uint32_t segment) const;
  void find_reaches() const;
  size_t place_of(uint32_t group) const {
    return to.places_.range.first_place + group - to.places_.range.first_group;
  }
  simd::RodReachJob reach_job(uint32_t group) const;
  void place_lanes(uint32_t group) const;
  // Into near_by_.near_lanes, of one group; false: none.
  bool near(uint32_t group, const simd::RodRound& round) const;
  bool near(uint32_t group, const simd::RodFlat& flat) const;
  bool may_enter(uint32_t group) const;
  // found(strand, segment) of near_by_.near_lanes.
  template <class Found>
  void for_near(uint32_t group, const Found& found) const;
  void touch(uint32_t group, uint32_t segment, uint32_t lanes, const simd::RodRound& round,
             simd::RodTouches* out) const;
  Sweep taken_sweep(uint32_t strand, uint32_t segment) const;
  Sweep sweep_of(const Capsule& capsule) const;
  void stop_torn(uint32_t strand, bool again) const;
  void stop_at_cores(uint32_t strand, uint32_t segment) const;
  void stop_at_cores() const;
  void stop_at_core(uint32_t strand, uint32_t segment, const Sweep& core) const;
  simd::RodRound round_of(const Other& other) const;
  simd::RodFlat flat_of(const Plane& plane) const;
  static uint64_t name_of(const Other& other, uint32_t strand, uint32_t segment, uint64_t feature);
  Contact made(uint32_t strand, uint32_t segment, double along, const Other& other, uint64_t feature) const;
  Contact* take() const;
  Contact* add(const Contact& contact, double depth_m, double restitution) const;
  void complete(Contact* contact, double depth_m, double restitution) const;
  void begin_force(Contact* contact) const;
  double rebound_m(const Contact& contact, double restitution) const;
  void set_gain(Contact* contact) const;
  Contact* add_point(const ContactPoint& point, uint64_t kind) const;
  void add_hits() const;
  void choose_cores() const;
  uint32_t probe_cores() const;
  bool look_at_cores() const;
  bool shrink_core(const ContactHit& hit) const;
  void stop_at_hits() const;
  void stop_at_hit(const ContactHit& hit) const;
  void probe(uint32_t strand, uint32_t segment, const Sweep& sweep, uint32_t* count) const;
  std::span<const ContactHit> ask(uint32_t probes, ContactHit* hits, uint32_t room, uint32_t* dropped) const;
  void add_plane(const Plane& plane, uint32_t index) const;
  void add_end(const Plane& plane, const Other& other, uint32_t strand, uint32_t segment, bool end) const;
  void add_round(const Capsule& capsule, uint64_t kind, uint32_t index) const;
  void add_near(uint32_t group, const Other& other, const simd::RodRound& round) const;
  uint32_t not_passing(uint32_t group, uint32_t segment, const Other& other) const;
  void add_lane(uint32_t strand, uint32_t segment, const Other& other, const simd::RodTouches& touches) const;
  void add_pair(uint32_t i, uint32_t j) const;
  bool overlap_at_rest(uint32_t strand, uint32_t i, uint32_t j) const;
  void add_touch(uint32_t strand, uint32_t segment, const Other& other) const;
  bool add_side_by_side(uint32_t strand, uint32_t segment, const Other& other, const Touch& touch) const;
  void add_at(uint32_t strand, uint32_t segment, const Other& other, const Nearest& at, const Vector& normal,
              double gap_then_m, double time, uint64_t feature) const;
};

}  // namespace sinew::rods

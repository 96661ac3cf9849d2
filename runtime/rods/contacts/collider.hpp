// collider.hpp  What a batch's rods touch in a step: obstacles, given contacts and one another.
//
// Handed to RodBatch::step. Rods are capsules, their whole length touches. Each step finds contacts once, on
// the way from where segments are to where they would go freely (find_contacts.cpp), so that what passes
// through something within a step touches it. Forces are part of the step's Newton iteration
// (contact_laws.cpp): a step that converges, RodReport::unconverged and contacts_unconverged both 0, ends
// where it does whatever it started from; one that ends at the cap depends on its start. What was iterated to
// is looked at once more, and a strand whose axis would be in the core of a sphere or capsule stops on its
// way there and counts as not converged: fast rods are caught, slower than momentum would have them. Between
// two rods, and at given points, there is no such second look.
// Forces go on from the last step, as they changed in it where the rods' start is continued. They are the
// collider's: what is to go on with the same bits saves and restores its state as well as the batch's.
// One thread at a time with its batch. A step allocates nothing. Memory: some 450 bytes a contact, and 700 a
// segment of the first 128 strands; where rods collide with one another, 600 a segment of all, for all groups
// then iterate in turn.
// Cost: a bound of each segment's way and of its distance from each obstacle near its group, a strand a lane
// in float (kernels/rod_contacts/rod_reach-inl.hpp); sweeps of what may touch, a strand a lane in double
// (kernels/rod_contacts/rod_touch-inl.hpp), and one at a time of all segments where rods collide or a source
// is asked; then gaps and forces in each iteration, a contact a lane
// (kernels/rod_contacts/rod_forces-inl.hpp), between two rods one at a time.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>

#include "core/aligned_block.hpp"
#include "kernels/rod_contacts/rod_touch_job.hpp"
#include "kernels/rods/rod_job.hpp"
#include "rods/contacts/collider_state.hpp"
#include "rods/contacts/contact.hpp"
#include "rods/contacts/find/spatial_hash.hpp"
#include "rods/contacts/find/sweep.hpp"
#include "rods/contacts/obstacle.hpp"
#include "sinew/contact_source.hpp"

namespace sinew::rods {

class RodBatch;
struct RodReport;

struct ColliderSettings {
  // Strands of the batch with one another and with themselves, but for segments that overlap at rest.
  bool rods_collide = true;
  float rod_friction = 0.3f;  // 0 or more, finite; between rods
  // 1e-4 to 1, share of a segment's radius: contacts have converged when gaps and slips are this exact, and
  // a strand's forces together, as a share of what friction gives. Twice this much of penetration is left
  // alone.
  float tolerance = 0.01f;
  // What is found in penetration is pushed out no faster at a contact. No bound of a strand's speed: what
  // lies deep in something round is pushed apart, part against part, and has left five times as fast in the
  // mean, a single segment fifteen times. Finite, above 0.
  float largest_push_out_m_s = 1;
  // Contacts at a time; further ones are dropped and counted, in the order given points, planes, spheres,
  // capsules, rods, each by group of strands, segment and strand. 0: four a segment, at least 64. At most
  // 2^24.
  uint32_t contact_capacity = 0;
  uint32_t obstacle_capacity = 64;  // of planes, of spheres and of capsules; at most 65536
  uint32_t point_capacity = 256;    // given contacts; at most 2^24
  // Hits of a source that a step takes, at most 2^24; 0: there is no source. Further ones are dropped and
  // counted with contacts. 300 bytes a hit and, where rods collide, 130 a segment.
  uint32_t source_capacity = 0;
};

class RodCollider {
 public:
  RodCollider() noexcept = default;
  // For batches of as many strands and segments as this one. Refused: settings outside their range, an empty
  // batch, no memory; `out` is then untouched.
  static Status create(const RodBatch& batch, const ColliderSettings& settings, RodCollider* out) noexcept;

  // Until set again. Refused: what check_obstacle refuses, more than obstacle_capacity; the last ones then
  // stay. An obstacle is known from step to step by its index.
  Status set_planes(std::span<const Plane> planes) noexcept;
  Status set_spheres(std::span<const Sphere> spheres) noexcept;
  Status set_capsules(std::span<const Capsule> capsules) noexcept;
  // Capsules that do not touch a segment, until set again: bit k is capsule k, those from 64 on touch all.
  // For what a rod hangs in. Refused: a strand or segment that is not there.
  Status set_passed(uint32_t strand, uint32_t segment, uint64_t capsules) noexcept;
  // For the coming step alone. Refused as well: a strand or segment that is not there, more than
  // point_capacity.
  Status set_points(std::span<const ContactPoint> points) noexcept;

  // Asked in each step, until set again, with the free segments that are stepped at a time: all where rods
  // collide, else a group of 16 strands or 4. Null: nobody is asked. `owner` goes into each probe.
  // Again, with half their radius, for segments that were iterated to where they had not been looked for, or
  // whose strand did not converge, if they or what their strand is near move further than their radius; twice
  // more, with four fifths of what they began at, those that begin in that. A strand that would be through
  // something is stopped on its way, and so looked at again, three times at most. After the step push is told
  // what each hit's contact did: minus what the rod felt; of a strand that did not converge, no more together
  // than what moved it. Source and what it looks at outlive the steps. Refused: a source where
  // source_capacity is 0; the last one then stays.
  Status set_source(ContactSource* source, uint32_t owner = 0) noexcept;
  // Where in the source's world the batch's places count from, 0 until set; finite. Obstacles and given
  // points are in the batch's own.
  void set_origin(const double (&origin_m)[3]) noexcept { std::copy_n(origin_m, 3, asked_.origin_m); }

  // The forces that `from`'s contacts came to in its last step, with this one's own settings, obstacles and
  // points; contacts are known by their obstacles' indices. Refused: one made for other strands or segments,
  // one with more contact_capacity; its own forces then stay. Allocates nothing.
  Status take_state(const RodCollider& from) noexcept;
  // In the last step.
  bool has_forces() const noexcept { return kept_forces_.kept_count > 0; }
  // What stepped on without it begins without forces again.
  void forget_forces() noexcept { keep_nothing(0); }
  // The same as bytes, always state_bytes() of them: for snapshots, next to RodBatch::save_state.
  size_t state_bytes() const noexcept;
  void save_state(std::byte* out) const noexcept;
  // Of what a collider for the same strands with the same contact_capacity saved.
  void restore_state(const std::byte* from) noexcept;

 private:
  friend class RodBatch;
  friend struct ColliderBuilder;
  friend struct ContactFinder;
  friend struct ContactForces;
  friend class ContactLooks;
  friend class ContactPushes;
  friend struct StrandPacker;

  template <class Obstacle>
  Status set(std::span<const Obstacle> given, uint32_t capacity, const char* what, Obstacle* to,
             uint32_t* count) noexcept;
  Status check_points(std::span<const ContactPoint> points) const noexcept;
  bool fits(const RodBatch& batch) const noexcept;
  // Null: there is none. Quick where names are asked for in the order in which they were kept.
  const KeptForce* find_kept(uint64_t name) noexcept;
  void keep(const KeptForce& kept) noexcept;
  static KeptForce kept_of(const Contact& contact, double per_square);
  void keep_force(const Contact& contact, double per_square) noexcept;
  void keep_nothing(uint32_t room_for) noexcept;
  bool passes(uint32_t strand, uint32_t segment, uint32_t capsule) const noexcept {
    return capsule < 64 && (obstacles_.passed[size_t{strand} * segment_count_ + segment] >> capsule & 1) != 0;
  }
  // Groups whose contacts are found together.
  uint32_t groups_of_range() const noexcept { return settings_.rods_collide ? places_.home_groups : 1; }
  bool has_place() const noexcept { return places_.place_count + groups_of_range() <= places_.home_groups; }
  // The parts of a step. Ranges begin one after the other, each in places of its own. One that has ended
  // before the next begins gives its places back; the others are joined, and end one after the other.
  void begin_step() noexcept;
  void begin_groups() noexcept;
  void open_range(uint32_t first_group) noexcept;
  void begin_range(const RodBatch& batch, float dt_s) noexcept;
  void give_back(const GroupRange& range) noexcept;
  void join_ranges() noexcept;
  // Before each iteration.
  void assemble(const RodBatch& batch) noexcept;
  // After each; `left`: iterations that may follow. Returns how many strands are not converged.
  uint32_t settle(const RodBatch& batch, uint32_t left) noexcept;
  void end_range(const RodBatch& batch, const GroupRange& range, float dt_s, RodReport* report) noexcept;
  void end_contacts(float dt_s, RodReport* report) noexcept;
  void end_step(float dt_s, RodReport* report) noexcept;
  void push(float dt_s) const noexcept;
  float* scratch(uint32_t place) const noexcept;
  // Where a strand's iterate is: a lane of its own group or, while others of that one rest, of one that is
  // packed.
  uint32_t& seat(uint32_t strand) const noexcept { return places_.seats[strand]; }
  // Of one lane; rows are width_ apart.
  float* scratch_row(const RodBatch& batch, uint32_t strand, uint32_t segment, uint32_t field) const noexcept;
  // Contacts' rows.
  void give(simd::RodJob* job, uint32_t place) const noexcept;
  simd::RodJob packed_job(simd::RodJob job, uint32_t place) const noexcept;

  core::AlignedBlock memory_;
  ColliderSettings settings_;
  uint32_t strand_count_ = 0, segment_count_ = 0, width_ = 0, capacity_ = 0;
  Obstacles obstacles_;
  FoundContacts found_;
  KeptForces kept_forces_;
  GroupPlaces places_;
  GoingOn going_;
  Reaches near_by_;
  ForceRows forces_on_;
  StrandProgress progress_;
  AskedSource asked_;
};

}  // namespace sinew::rods

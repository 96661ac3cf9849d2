// contact_forces.hpp  Contacts' forces at the iterate, and what an iteration is to know of them.
#pragma once
#include <limits>

#include "rods/contacts/collider.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {

struct ContactForces {
  RodCollider& to;
  const RodBatch& batch;

  void clear() const noexcept;
  // Of the range, at the step's first iterate; all its strands are to be iterated.
  void begin() const noexcept;
  // Before an iteration: the forces of those that go on, as rows of their system.
  void assemble() const noexcept;
  // After an iteration that so many may follow: takes forces over, and says which strands go on, in
  // kLaneActive. Returns how many.
  uint32_t settle(uint32_t left) const noexcept;
  // A strand that touches something and still turns a little each iteration keeps its forces: it counts as
  // one whose contacts did not converge.
  void forgive() const noexcept;
  // Strands whose way is below 1 end there; they count as not converged.
  void hold() const noexcept;
  // Where the range's hits of a source touch at the iterate, and what they are pushed with.
  void place_hits() const noexcept;
  // After the last: kLaneActive is again what the rods themselves said. Returns how many strands are not
  // converged by their contacts.
  uint32_t end() const noexcept;
  // Of the range, what gap and slip miss by while their force stays: 0 where C = 0 or
  // p = 0, and s = 0 or |t| = friction p. In mean segment lengths of the first side's strand.
  double miss() const noexcept;

 private:
  friend class ContactLooks;
  friend class ContactTakes;
  friend class ContactPushes;
  uint32_t first_strand() const { return to.places_.range.first_group * batch.width_; }
  uint32_t end_strand() const;
  float& lane(uint32_t strand, uint32_t field) const {
    const uint32_t at = to.seat(strand), place = batch.group_of(at);
    const bool packed = place >= to.places_.home_groups;
    float* lanes = packed ? to.places_.packed_lanes : batch.lanes_;
    const size_t group = packed ? place - to.places_.home_groups : to.places_.homes[place];
    return lanes[(group * simd::kLaneFields + field) * batch.width_ + batch.lane_of(at)];
  }
  float& active(uint32_t strand) const { return lane(strand, simd::kLaneActive); }
  Turn turn_now(const Contact::Side& side) const {
    const float* q = to.scratch_row(batch, side.strand, side.segment, simd::kRodNow);
    const size_t w = batch.width_;
    return {q[0], q[w], q[2 * w], q[3 * w]};
  }
  std::span<Contact> contacts() const {
    return {to.found_.contacts + to.places_.range.first_contact,
            to.places_.range.end_contact - to.places_.range.first_contact};
  }
  // Of the range, and what of it goes on.
  std::span<const uint32_t> going_strands() const {
    return {to.going_.strands + to.going_.first_strand, to.going_.strand_count - to.going_.first_strand};
  }
  std::span<const uint32_t> going_contacts() const {
    return {to.going_.contacts + to.going_.first_contact, to.going_.contact_count - to.going_.first_contact};
  }
  bool goes_on(uint32_t strand) const {
    return (to.progress_.turning[strand] | to.progress_.pending[strand]) != 0;
  }
  bool goes_on(const Contact& c) const {
    return goes_on(c.sides[0].strand) || (c.has_two_rods() && goes_on(c.sides[1].strand));
  }
  bool iterated(const Contact& c) const {
    return to.progress_.iterated[c.sides[0].strand] ||
           (c.has_two_rods() && to.progress_.iterated[c.sides[1].strand]);
  }
  static bool is_clear(const Contact& contact);
  void leave_out(Contact* contact) const;
  void go_on() const;
  void take_in(uint32_t contact) const;
  bool any_reached() const;
  void leave_out_what_rests() const;
  double moved_m(uint32_t strand) const;
  // Less than this, and a contact that does not press still does not, nor is it in penetration.
  static double clear_m(const Contact& c) { return c.open_m + std::min(c.allowed_m, 0.0); }
  void take_in_what_was_reached() const;
  // Gap and slip at the iterate.
  void look(Contact* contact) const;
  // A strand that is lost touches nothing: others are not to be lost with it.
  static void let_go_of_lost(Contact* contact) {
    if (std::isfinite(contact->open_m) && finite(contact->slip_m)) return;
    contact->open_m = std::numeric_limits<double>::max();
    contact->force = 0;
    contact->slip_m = contact->drag = {};
  }
  Vector move(const Contact& contact, size_t side) const;
  Vector surface_move(const Contact& contact, size_t side, const Vector& move) const;
  double last_turn(uint32_t strand) const;
  void forget_changes() const;

  // contact_laws.cpp
  void begin_friction(Contact* contact) const;
  // Between two rods; with obstacles: contact_lanes.cpp.
  bool take_over(Contact* contact) const;
  // Where gap and slip are not as exact as wanted its strands are not done.
  void keep_pending(const Contact& contact, bool exact) const {
    if (exact) return;
    to.progress_.pending[contact.sides[0].strand] = 1;
    if (contact.has_two_rods()) to.progress_.pending[contact.sides[1].strand] = 1;
  }
  double tolerance_m(const Contact& contact) const;
  double nothing_m(const Contact& contact) const;
  double share_of(const Contact& contact) const;
  double mass_kg(const Contact& contact) const;
  double limit_of_new(const Contact& contact) const;
  bool begin_anew(Contact* contact) const;
  bool slides_on(const Contact& contact, const Vector& slip) const;
  bool slid(const Contact& contact) const;
  bool update_friction(Contact* contact, const Vector& slip) const;
  Vector taken_drag(const Contact& contact, const Vector& slip, bool comes_to_rest) const;
  // What a contact went into an iteration with.
  struct Before {
    double force;
    Vector drag;
    Friction state;
    ContactForce linearised;  // of its linear system
  };
  double law_miss(const Contact& contact, const Before& before) const;
  double rounding_kg_m(const Contact& contact) const;
  void add_miss(const Contact& contact, double miss) const;
  bool is_exact(const Contact& contact, const Before& before) const;

  // contact_ways.cpp
  void find_ways() const;
  void stop_at_new_contacts(uint32_t left) const;
  double deep_after(uint32_t left) const;
  bool stepped_back(const Contact& contact) const;
  void shorten(const Contact& contact, double start, double deep) const;
  void step_back(uint32_t strand, uint32_t segment) const;
  void take_back(uint32_t strand) const;
  void turn_part(uint32_t strand, uint32_t segment, uint32_t field) const;
  void hold(uint32_t strand, uint32_t segment) const;

  // push_source.cpp
  void find_felt() const;
  void limit_felt() const;
  double moved_kg_m(uint32_t strand) const;

  // contact_rows.cpp
  void assemble_ended() const;
  void add(const Contact& contact) const;
  void add_to_side(const Contact& contact, size_t side, const ContactForce& f, const Vector& force) const;
  float* touched_rows(uint32_t strand, uint32_t segment) const;
};

}  // namespace sinew::rods

// contact_forces.cpp  The augmented Lagrangian's iteration: where contacts are, and which strands go on.
#include "rods/contact_forces.hpp"

#include <algorithm>
#include <limits>

#include "rods/contact_lanes.hpp"

namespace sinew::rods {
namespace {

constexpr double kForgiven = 10;  // of the rods' tolerance

}  // namespace

uint32_t ContactForces::end_strand() const {
  return std::min(batch.strand_count_, first_strand() + to.range_.groups * batch.width_);
}

// What a side's point moved in this step.
Vector ContactForces::move(const Contact& c, size_t side) const {
  const Contact::Side& s = c.sides[side];
  if (s.segment == kNoSegment) return c.obstacle_move;
  const float* d = to.scratch_row(batch, s.strand, s.segment, simd::kRodMove);
  const size_t w = batch.width_;
  const Vector middle = scaled(batch.units_[s.strand].length_m, {d[0], d[w], d[2 * w]});
  return scaled_sum(s.along_m, difference(axes_of(turn_now(s)).z, s.axis), middle);
}

// And its surface there, of a point that moved so.
Vector ContactForces::surface_move(const Contact& c, size_t side, const Vector& move) const {
  const Contact::Side& s = c.sides[side];
  if (s.segment == kNoSegment) return move;
  const float* q = &batch.at(s.strand, s.segment, simd::kRodTurn);
  const size_t w = batch.width_;
  const Turn before = {q[0], q[w], q[2 * w], q[3 * w]}, turn = turn_now(s);
  const Turn by = product(conjugate(before), turn);
  const Axes own = axes_of(turn);
  const double side_of = by[3] < 0 ? -2 : 2;
  const Vector turned_by =
      scaled(side_of, scaled_sum(by[0], own.x, scaled_sum(by[1], own.y, scaled(by[2], own.z))));
  return scaled_sum(s.radius_m, cross(turned_by, c.normal), move);
}

// Gap and, where it is or was pressed, slip at the iterate.
void ContactForces::look(Contact* c) const {
  const Vector a = move(*c, 0), b = move(*c, 1);
  c->open_m = c->gap_m + dot(c->normal, difference(a, b)) - c->allowed_m;
  c->slip_m = {};
  if (is_active(*c, c->open_m) || is_active(*c, c->open_before_m)) {
    c->slip_m = across(difference(surface_move(*c, 0, a), surface_move(*c, 1, b)), c->normal);
  }
  let_go_of_lost(c);
}

void ContactForces::all_go_on() const {
  to.first_going_strand_ = to.going_strand_count_;
  to.first_going_contact_ = to.going_contact_count_;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) to.going_strands_[to.going_strand_count_++] = s;
  for (uint32_t i = to.range_.first_contact; i < to.range_.end_contact; ++i)
    to.going_contacts_[to.going_contact_count_++] = i;
}

// Where rods collide, what rests may be woken.
void ContactForces::leave_out_what_rests() const {
  if (to.settings_.rods_collide) return;
  const auto keep = [](uint32_t* from, uint32_t* end, const auto& goes) {
    return std::remove_if(from, end, [&](uint32_t i) { return !goes(i); });
  };
  uint32_t* strands = to.going_strands_;
  to.going_strand_count_ =
      static_cast<uint32_t>(keep(strands + to.first_going_strand_, strands + to.going_strand_count_,
                                 [&](uint32_t s) {
                                   to.iterated_[s] = goes_on(s);
                                   return goes_on(s);
                                 }) -
                            strands);
  uint32_t* contacts = to.going_contacts_;
  to.going_contact_count_ =
      static_cast<uint32_t>(keep(contacts + to.first_going_contact_, contacts + to.going_contact_count_,
                                 [&](uint32_t i) { return goes_on(to.contacts_[i].sides[0].strand); }) -
                            contacts);
}

// Strands that would start deep in something start where they first touch it: an iteration that is cut short,
// by its cap or by how far segments may turn in it, then leaves them in front of it, slower, not behind.
void ContactForces::begin() const noexcept {
  all_go_on();
  ContactLooks looks(*this);
  for (Contact& c : contacts()) looks.add(&c);
  looks.end();
  find_ways();
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    to.turning_[s] = 0;
    to.pending_[s] = 1;
    for (uint32_t i = 0; to.ways_[s] < 1 && i < batch.segment_count_; ++i) step_back(s, i);
  }
  for (Contact& c : contacts()) {
    if (stepped_back(c)) look(&c);
    begin_friction(&c);
  }
}

uint32_t ContactForces::settle(uint32_t left) const noexcept {
  for (const uint32_t s : going_strands()) {
    to.iterated_[s] = to.turning_[s] | to.pending_[s];
    to.turning_[s] = active(s) != 0;
    to.pending_[s] = 0;
    to.misses_[s] = to.presses_[s] = 0;
  }
  ContactLooks looks(*this);
  for (const uint32_t i : going_contacts()) {
    Contact& c = to.contacts_[i];
    if (!iterated(c)) continue;
    c.open_before_m = c.open_m;
    c.slip_before_m = c.slip_m;
    looks.add(&c);
  }
  looks.end();
  find_felt();
  stop_at_new_contacts(left);
  ContactTakes takes(*this);
  for (const uint32_t i : going_contacts()) {
    if (iterated(to.contacts_[i])) takes.add(&to.contacts_[i]);
  }
  takes.end();
  uint32_t count = 0;
  for (const uint32_t s : going_strands()) {
    to.pending_[s] |= to.iterated_[s] && to.ways_[s] < 1;  // what is cut short has not got to its end
    to.pending_[s] |= to.misses_[s] > static_cast<double>(to.settings_.tolerance) * to.presses_[s];
    active(s) = to.turning_[s] | to.pending_[s] ? 1.0f : 0.0f;
    count += active(s) != 0;
  }
  leave_out_what_rests();
  return count;
}

// The largest turn of the last iteration; infinity where what is held is out of reach.
double ContactForces::last_turn(uint32_t strand) const {
  const float miss = lane(strand, simd::kLaneHeldMiss);
  const double tolerance = static_cast<double>(batch.settings_.tolerance_rad);
  if (!(static_cast<double>(miss) <= tolerance * tolerance)) return std::numeric_limits<double>::max();
  double square = 0;
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    const auto turn = [&](uint32_t k) {
      return static_cast<double>(*to.scratch_row(batch, strand, i, simd::kRodImpulse + 3 + k));
    };
    const Vector v = {turn(0), turn(1), turn(2)};
    square = std::max(square, dot(v, v));
  }
  return std::sqrt(square);
}

void ContactForces::forgive() const noexcept {
  const double most = kForgiven * static_cast<double>(batch.settings_.tolerance_rad);
  std::fill(to.near_ + first_strand(), to.near_ + end_strand(), uint8_t{0});
  for (const Contact& c : contacts()) {
    for (const Contact::Side& side : c.sides) {
      if (side.segment == kNoSegment) continue;
      to.near_[side.strand] = 1;
      if (!(c.force > 0) || !to.turning_[side.strand] || !(last_turn(side.strand) < most)) continue;
      to.turning_[side.strand] = 0;
      to.pending_[side.strand] = 1;
    }
  }
}

void ContactForces::hold() const noexcept {
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    if (!(to.ways_[s] < 1)) continue;
    to.turning_[s] = to.pending_[s] = 1;
    for (uint32_t i = 0; i < batch.segment_count_; ++i) hold(s, i);
  }
  for (Contact& c : contacts()) look(&c);
}

uint32_t ContactForces::end() const noexcept {
  for (Contact& c : contacts()) {
    const bool ended =
        !to.pending_[c.sides[0].strand] && !(c.has_two_rods() && to.pending_[c.sides[1].strand]);
    if (!ended) c.last = {};  // no change to go on with
  }
  uint32_t count = 0;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    active(s) = to.turning_[s] ? 1.0f : 0.0f;
    count += to.pending_[s];
    to.pending_[s] = 1;
  }
  // What the residual is measured with is of all strands.
  if (batch.settings_.report_residual) assemble_ended();
  return count;
}

double ContactForces::miss() const noexcept {
  double largest = 0;
  for (uint32_t i = 0; i < to.contact_count_; ++i) {
    const Contact& c = to.contacts_[i];
    const ContactForce f = forces_of(c);
    const double off = std::max(std::fabs(f.press - c.force), length(difference(f.drag, c.drag))) / c.gain_kg;
    largest = std::max(largest, off / static_cast<double>(batch.units_[c.sides[0].strand].length_m));
  }
  return largest;
}

}  // namespace sinew::rods

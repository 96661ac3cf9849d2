// contact_forces.cpp  The augmented Lagrangian's iteration: where contacts are, and which strands go on.
#include "rods/contacts/solve/contact_forces.hpp"

#include <algorithm>
#include <limits>

#include "rods/contacts/solve/contact_lanes.hpp"

namespace sinew::rods {
namespace {

constexpr double kForgiven = 10;     // of the rods' tolerance
constexpr double kRoundings = 1e-5;  // of a way in float, and of a segment's length

}  // namespace

uint32_t ContactForces::end_strand() const {
  return std::min(batch.strand_count_, first_strand() + to.places_.range.groups * batch.width_);
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

// A contact with an obstacle that is open where its strand begins, and has no force.
bool ContactForces::is_clear(const Contact& c) {
  return !c.has_two_rods() && !(c.force > 0) && clear_m(c) > 0;
}

void ContactForces::leave_out(Contact* c) const {
  c->is_left_out = true;
  double& clear = to.progress_.clear_m[c->sides[0].strand];
  clear = std::min(clear, clear_m(*c));
}

// All strands of the range, and contacts but what is clear.
void ContactForces::go_on() const {
  to.going_.first_strand = to.going_.strand_count;
  to.going_.first_contact = to.going_.contact_count;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    to.going_.strands[to.going_.strand_count++] = s;
    to.progress_.clear_m[s] = std::numeric_limits<double>::max();
    to.progress_.passed_m[s] = to.progress_.moves_m[s] = 0;
  }
  for (uint32_t i = to.places_.range.first_contact; i < to.places_.range.end_contact; ++i) {
    Contact& c = to.found_.contacts[i];
    is_clear(c) ? leave_out(&c) : take_in(i);
  }
}

void ContactForces::take_in(uint32_t contact) const {
  to.found_.contacts[contact].is_left_out = false;
  to.going_.contacts[to.going_.contact_count++] = contact;
}

// Whether a strand may have got to a contact that is left out.
bool ContactForces::any_reached() const {
  const auto reached = [this](uint32_t s) {
    return !(to.progress_.clear_m[s] > to.progress_.passed_m[s] + to.progress_.moves_m[s]);
  };
  return std::any_of(going_strands().begin(), going_strands().end(), reached);
}

// What was left out and may have been reached goes on too, from what it was open by before, at least.
void ContactForces::take_in_what_was_reached() const {
  for (const uint32_t s : going_strands()) {
    if (to.progress_.iterated[s]) to.progress_.clear_m[s] = std::numeric_limits<double>::max();
  }
  for (uint32_t i = to.places_.range.first_contact; i < to.places_.range.end_contact; ++i) {
    Contact& c = to.found_.contacts[i];
    const uint32_t s = c.sides[0].strand;
    if (!c.is_left_out || !to.progress_.iterated[s]) continue;
    if (clear_m(c) > to.progress_.passed_m[s] + to.progress_.moves_m[s]) {
      leave_out(&c);
    } else {
      c.open_m -= to.progress_.passed_m[s];
      take_in(i);
    }
  }
}

// Where rods collide, what rests may be woken.
void ContactForces::leave_out_what_rests() const {
  if (to.settings_.rods_collide) return;
  const auto keep = [](uint32_t* from, uint32_t* end, const auto& goes) {
    return std::remove_if(from, end, [&](uint32_t i) { return !goes(i); });
  };
  uint32_t* strands = to.going_.strands;
  to.going_.strand_count =
      static_cast<uint32_t>(keep(strands + to.going_.first_strand, strands + to.going_.strand_count,
                                 [&](uint32_t s) {
                                   to.progress_.iterated[s] = goes_on(s);
                                   return goes_on(s);
                                 }) -
                            strands);
  uint32_t* contacts = to.going_.contacts;
  to.going_.contact_count =
      static_cast<uint32_t>(keep(contacts + to.going_.first_contact, contacts + to.going_.contact_count,
                                 [&](uint32_t i) { return goes_on(to.found_.contacts[i].sides[0].strand); }) -
                            contacts);
}

// Strands that would start deep in something start where they first touch it: an iteration that is cut short,
// by its cap or by how far segments may turn in it, then leaves them in front of it, slower, not behind.
void ContactForces::begin() const noexcept {
  ContactLooks looks(*this);
  for (Contact& c : contacts()) {
    c.is_looked_at ? let_go_of_lost(&c) : looks.add(&c);
  }
  looks.end();
  find_ways();
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    to.progress_.turning[s] = to.progress_.near[s] = 0;
    to.progress_.pending[s] = 1;
    for (uint32_t i = 0; to.progress_.ways[s] < 1 && i < batch.segment_count_; ++i) step_back(s, i);
  }
  for (Contact& c : contacts()) {
    if (stepped_back(c)) look(&c);
    to.progress_.near[c.sides[0].strand] = 1;
    if (c.has_two_rods()) to.progress_.near[c.sides[1].strand] = 1;
  }
  go_on();
  for (const uint32_t i : going_contacts()) begin_friction(&to.found_.contacts[i]);
}

// How far the last iteration moved a point of a strand, at most.
double ContactForces::moved_m(uint32_t s) const {
  if (!to.progress_.iterated[s]) return 0;
  const double length = static_cast<double>(batch.units_[s].length_m);
  return length * ((1 + kRoundings) * static_cast<double>(lane(s, simd::kLaneMoved)) + kRoundings);
}

uint32_t ContactForces::settle(uint32_t left) const noexcept {
  for (const uint32_t s : going_strands()) {
    to.progress_.iterated[s] = to.progress_.turning[s] | to.progress_.pending[s];
    to.progress_.turning[s] = active(s) != 0;
    to.progress_.pending[s] = 0;
    to.progress_.misses[s] = to.progress_.presses[s] = 0;
    to.progress_.moves_m[s] = moved_m(s);
  }
  if (any_reached()) take_in_what_was_reached();
  for (const uint32_t s : going_strands()) to.progress_.passed_m[s] += to.progress_.moves_m[s];
  ContactLooks looks(*this);
  for (const uint32_t i : going_contacts()) {
    Contact& c = to.found_.contacts[i];
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
    if (iterated(to.found_.contacts[i])) takes.add(&to.found_.contacts[i]);
  }
  takes.end();
  uint32_t count = 0;
  for (const uint32_t s : going_strands()) {
    to.progress_.pending[s] |=
        to.progress_.iterated[s] && to.progress_.ways[s] < 1;  // what is cut short has not got to its end
    to.progress_.pending[s] |=
        to.progress_.misses[s] > static_cast<double>(to.settings_.tolerance) * to.progress_.presses[s];
    active(s) = to.progress_.turning[s] | to.progress_.pending[s] ? 1.0f : 0.0f;
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
  const uint8_t *first = to.progress_.turning + first_strand(), *end = to.progress_.turning + end_strand();
  if (std::none_of(first, end, [](uint8_t turns) { return turns; })) return;
  for (const Contact& c : contacts()) {
    for (const Contact::Side& side : c.sides) {
      if (side.segment == kNoSegment) continue;
      if (!(c.force > 0) || !to.progress_.turning[side.strand] || !(last_turn(side.strand) < most)) continue;
      to.progress_.turning[side.strand] = 0;
      to.progress_.pending[side.strand] = 1;
    }
  }
}

void ContactForces::hold() const noexcept {
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    if (!(to.progress_.ways[s] < 1)) continue;
    to.progress_.turning[s] = to.progress_.pending[s] = 1;
    for (uint32_t i = 0; i < batch.segment_count_; ++i) hold(s, i);
  }
  for (Contact& c : contacts()) look(&c);
}

// No change to go on with.
void ContactForces::forget_changes() const {
  for (Contact& c : contacts()) {
    const bool ended = !to.progress_.pending[c.sides[0].strand] &&
                       !(c.has_two_rods() && to.progress_.pending[c.sides[1].strand]);
    if (!ended) c.last = {};
  }
}

uint32_t ContactForces::end() const noexcept {
  uint32_t count = 0;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    active(s) = to.progress_.turning[s] ? 1.0f : 0.0f;
    count += to.progress_.pending[s];
  }
  if (count > 0) forget_changes();
  std::fill(to.progress_.pending + first_strand(), to.progress_.pending + end_strand(), uint8_t{1});
  // What the residual is measured with is of all strands.
  if (batch.settings_.report_residual) assemble_ended();
  return count;
}

double ContactForces::miss() const noexcept {
  double largest = 0;
  for (const Contact& c : contacts()) {
    const ContactForce f = forces_of(c);
    const double off = std::max(std::fabs(f.press - c.force), length(difference(f.drag, c.drag))) / c.gain_kg;
    largest = std::max(largest, off / static_cast<double>(batch.units_[c.sides[0].strand].length_m));
  }
  return largest;
}

}  // namespace sinew::rods

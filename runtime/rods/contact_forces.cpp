// contact_forces.cpp  The augmented Lagrangian's forces, and their rows for the rods' own iteration.
#include "rods/contact_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::rods {
namespace {

constexpr size_t triangle(size_t row, size_t column) { return row * (row + 1) / 2 + column; }

constexpr double kDeep = 0.5;    // of a segment's radius
constexpr double kAcross = 1.5;  // the same: next to where two rods' axes cross
// Of friction's state in a step: a first one mends the guess, a second mends it again with the limit that was
// found; a third takes that back and would go on so.
constexpr uint32_t kMostChanges = 2;
// Of a segment's length, what of a gap no iteration closes: a turn in float, at half of it.
constexpr double kRounding = 3e-8;
constexpr double kAtLimit = 0.999;  // of the limit: less is not a rounding
constexpr double kForgiven = 10;    // of the rods' tolerance

}  // namespace

uint32_t ContactForces::end_strand() const {
  return std::min(batch.strand_count_, first_strand() + to.range_.groups * batch.width_);
}

float& ContactForces::lane(uint32_t strand, uint32_t field) const {
  const size_t group = strand / batch.width_;
  return batch.lanes_[(group * simd::kLaneFields + field) * batch.width_ + strand % batch.width_];
}

float& ContactForces::active(uint32_t strand) const { return lane(strand, simd::kLaneActive); }

ContactForces::Axes ContactForces::axes_of(const Turn& q) {
  const double xx = 2 * q[0] * q[0], yy = 2 * q[1] * q[1], zz = 2 * q[2] * q[2];
  const double xy = 2 * q[0] * q[1], xz = 2 * q[0] * q[2], yz = 2 * q[1] * q[2];
  const double xw = 2 * q[0] * q[3], yw = 2 * q[1] * q[3], zw = 2 * q[2] * q[3];
  return {{1 - yy - zz, xy + zw, xz - yw}, {xy - zw, 1 - xx - zz, yz + xw}, {xz + yw, yz - xw, 1 - xx - yy}};
}

Turn ContactForces::turn_now(const Contact::Side& s) const {
  const float* q = to.scratch_row(batch, s.strand, s.segment, simd::kRodNow);
  const size_t w = batch.width_;
  return {q[0], q[w], q[2 * w], q[3 * w]};
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

// Gap and, where it is or was pressed, slip at the iterate. A strand that is lost touches
// nothing: others are not to be lost with it.
void ContactForces::look(Contact* c) const {
  const Vector a = move(*c, 0), b = move(*c, 1);
  c->open_m = c->gap_m + dot(c->normal, difference(a, b)) - c->allowed_m;
  c->slip_m = {};
  if (is_active(*c, c->open_m) || is_active(*c, c->open_before_m)) {
    c->slip_m = across(difference(surface_move(*c, 0, a), surface_move(*c, 1, b)), c->normal);
  }
  if (std::isfinite(c->open_m) && finite(c->slip_m)) return;
  c->open_m = std::numeric_limits<double>::max();
  c->force = 0;
  c->slip_m = c->drag = {};
}

bool ContactForces::iterated(const Contact& c) const {
  return to.iterated_[c.sides[0].strand] || (c.has_two_rods() && to.iterated_[c.sides[1].strand]);
}

double ContactForces::tolerance_m(const Contact& c) const {
  return static_cast<double>(to.settings_.tolerance) * c.scale_m;
}

// Of the iteration's change, what was taken by the strands of a contact.
double ContactForces::share_of(const Contact& c) const {
  const auto share = [&](size_t side) {
    return static_cast<double>(lane(c.sides[side].strand, simd::kLaneShare));
  };
  return c.has_two_rods() ? std::min(share(0), share(1)) : share(0);
}

// Less moves nothing: a tolerance of the tolerance.
double ContactForces::nothing_m(const Contact& c) const {
  return static_cast<double>(to.settings_.tolerance) * tolerance_m(c);
}

// That a contact's force moves, of the pair.
double ContactForces::mass_kg(const Contact& c) const {
  return c.gain_kg / (c.has_two_rods() ? kRodGain : kObstacleGain);
}

double ContactForces::limit_of_new(const Contact& c) const {
  return c.friction * mass_kg(c) * std::max(0.0, -c.open_m);
}

// One that was not part of the last system. Returns whether it stays so.
bool ContactForces::begin_anew(Contact* c) const {
  const bool was_pressed = c->force > 0;
  c->force = 0, c->drag = {};
  c->limit = limit_of_new(*c);
  c->state = Friction::kSlides, c->changes = 0;
  return !was_pressed && c->open_m >= -tolerance_m(*c);
}

// Against its drag, twice beyond its limit, the way it slid before and further.
bool ContactForces::slides_on(const Contact& c, const Vector& slip) const {
  if (!(dot(slip, c.drag) < 0) || !(dot(slip, c.slip_before_m) > 0)) return false;
  if (!(dot(slip, slip) > dot(c.slip_before_m, c.slip_before_m))) return false;
  return length(scaled_sum(-c.gain_kg, slip, c.drag)) > 2 * c.limit;
}

// What slides and is carried back, or drags less than its limit, sticks; what drags more slides. What may be
// either slides where it goes on sliding, and further: by the slip's own size it would get there only slowly.
// Returns whether it changed; to go on sliding is none.
bool ContactForces::update_friction(Contact* c, const Vector& slip) const {
  if (c->state == Friction::kEither) {
    if (slides_on(*c, slip)) c->state = Friction::kSlides;
    return false;
  }
  const double drag = length(scaled_sum(-c->gain_kg, slip, c->drag));
  const bool slides = c->state == Friction::kSlides;
  const bool changes = slides ? dot(slip, c->drag) > 0 || drag < c->limit : drag > c->limit;
  if (!changes) return false;
  c->state = ++c->changes > kMostChanges ? Friction::kEither : slides ? Friction::kSticks : Friction::kSlides;
  return true;
}

// Of what slipped so, from the drag it had.
Vector ContactForces::taken_drag(const Contact& c, const Vector& slip, bool comes_to_rest) const {
  if (!comes_to_rest) return forces_of(c, 0, slip).drag;
  const double size = length(c.drag);
  return size > c.limit ? scaled(c.limit / size, c.drag) : c.drag;
}

// What the forces that a system came to miss contact's laws by, kg m: a pull, drag that is more than friction
// gives, or that does not go against the slip. Nothing where nothing stuck and the iteration moved nothing:
// where friction is at its limit and nothing slides, drags are not unique. The gain makes a force of each
// gap's rounding.
double ContactForces::law_miss(const Contact& c, const Contact& before) const {
  const double moved =
      std::max(std::fabs(c.open_m - c.open_before_m), length(difference(c.slip_m, c.slip_before_m)));
  const bool sticks = before.state == Friction::kSticks;
  if (!sticks && moved <= nothing_m(c)) return 0;
  const double pull = std::max(0.0, before.gain_kg * c.open_m - before.force);
  const double length_m = static_cast<double>(batch.units_[c.sides[0].strand].length_m);
  const double rounding = kRounding * length_m * c.gain_kg;
  if (!(c.friction > 0)) return std::max(0.0, pull - rounding);
  const ContactForce then = forces_of(before, c.open_before_m, c.slip_before_m);
  const Vector drag = drag_after(before, then, difference(c.slip_m, c.slip_before_m));
  const double limit = c.friction * c.force;
  Vector lawful = sticks ? drag : scaled_sum(-c.gain_kg, c.slip_m, drag);
  const double size = length(lawful);
  if (size > limit) lawful = scaled(limit / size, lawful);
  return std::max(0.0, pull + length(difference(lawful, drag)) - rounding);
}

// Whether gap and slip are as exact as wanted. Against what does not iterate they are what is left of them;
// between rods, which iterate in turn, what an iteration still changes.
bool ContactForces::is_exact(const Contact& c, const Contact& before) const {
  if (!c.has_two_rods()) {
    const bool sticks = before.state == Friction::kSticks && c.friction > 0;
    return std::max(std::fabs(c.open_m), sticks ? length(c.slip_m) : 0.0) <= tolerance_m(c);
  }
  const double off =
      std::max(std::fabs(c.force - before.force), length(difference(c.drag, before.drag))) / c.gain_kg;
  const double moved = std::max(std::fabs(c.open_m - c.open_before_m),
                                c.friction > 0 ? length(difference(c.slip_m, c.slip_before_m)) : 0.0);
  return std::max(off, c.slowness * moved) <= tolerance_m(c);
}

// Of a strand together, against what friction gives, or what presses where there is none: small forces next
// to large ones need not be as exact.
void ContactForces::add_miss(const Contact& c, const Contact& before) const {
  const double miss = law_miss(c, before);
  for (const Contact::Side& side : c.sides) {
    if (side.segment == kNoSegment) continue;
    to.misses_[side.strand] += miss;
    to.presses_[side.strand] += (c.friction > 0 ? c.friction : 1.0) * c.force;
  }
}

// The forces of an iteration, as far as it was taken: with the whole gap, one left by a half step would be
// pressed out again by a thousand masses. The limit is of a force that a system came to, not of what a gap
// asks for, a hundred times that. Two contacts at right angles throw each other's force to and fro, what one
// drags presses the other: errors turn by i friction an iteration, and of all shares of a change
// 1 / (1 + friction^2) leaves least of them. Returns whether the contact is as exact as wanted.
bool ContactForces::take_over(Contact* c) const {
  if (!is_active(*c, c->open_before_m)) return begin_anew(c);
  const Contact before = *c;
  const double left = 1 - share_of(*c);
  const Vector slip = scaled_sum(-left, c->slip_before_m, c->slip_m);
  c->force = std::max(0.0, c->force - c->gain_kg * (c->open_m - left * c->open_before_m));
  c->limit += (c->friction * c->force - c->limit) / (1 + c->friction * c->friction);
  const bool changed = c->force > 0 && update_friction(c, slip);
  const bool rests = changed && before.state == Friction::kSlides;
  c->drag = taken_drag(*c, slip, rests);
  add_miss(*c, before);
  return is_exact(*c, before);
}

// At its limit, and on its way against its drag where the step begins.
bool ContactForces::slid(const Contact& c) const {
  const double drag = length(c.drag);
  return drag >= kAtLimit * c.limit && -dot(c.slip_m, c.drag) > nothing_m(c) * drag;
}

// What slid goes on, and what is new slides where it is too fast to be held.
void ContactForces::begin_friction(Contact* c) const {
  const bool known = c->force > 0;
  c->limit = known ? c->friction * c->force : limit_of_new(*c);
  const bool slides = known ? slid(*c) : mass_kg(*c) * length(c->slip_m) > c->limit;
  c->state = slides ? Friction::kSlides : Friction::kSticks;
}

std::span<Contact> ContactForces::contacts() const {
  return {to.contacts_ + to.first_contact_, to.contact_count_ - to.first_contact_};
}

// What share of its way a strand goes before it is deep in something.
void ContactForces::find_ways() const {
  std::fill(to.ways_ + first_strand(), to.ways_ + end_strand(), 1.0);
  for (const Contact& c : contacts()) {
    if (!(c.open_m < -kDeep * c.scale_m)) continue;
    shorten(c, std::max(c.gap_m - c.allowed_m, 0.0), kDeep);
  }
}

bool ContactForces::stepped_back(const Contact& c) const {
  return to.ways_[c.sides[0].strand] < 1 || (c.has_two_rods() && to.ways_[c.sides[1].strand] < 1);
}

// A way that opened at `start` and leads deep into a contact ends where the contact has just closed; one that
// began in it where it is deep, or at once.
void ContactForces::shorten(const Contact& c, double start, double deep) const {
  const double least = (start > 0 ? 0.25 * deep : kAcross) * c.scale_m;
  const double way = std::max(0.0, start + least) / (start - c.open_m);
  to.ways_[c.sides[0].strand] = std::min(to.ways_[c.sides[0].strand], way);
  if (c.has_two_rods()) to.ways_[c.sides[1].strand] = std::min(to.ways_[c.sides[1].strand], way);
}

// The iterate's turn: ways_'s share of the way from the step's start to the turn in `field`.
void ContactForces::turn_part(uint32_t strand, uint32_t segment, uint32_t field) const {
  const double way = to.ways_[strand];
  Turn before, after;
  for (uint32_t k = 0; k < 4; ++k) {
    before[k] = static_cast<double>(batch.at(strand, segment, simd::kRodTurn + k));
    after[k] = static_cast<double>(*to.scratch_row(batch, strand, segment, field + k));
  }
  const double side = product(conjugate(before), after)[3] < 0 ? -1 : 1;
  for (size_t k = 0; k < 4; ++k) after[k] = (1 - way) * side * before[k] + way * after[k];
  after = normalised(after);
  for (uint32_t k = 0; k < 4; ++k) {
    *to.scratch_row(batch, strand, segment, simd::kRodNow + k) = static_cast<float>(after[k]);
  }
}

// The iterate that share of the way to free motion, without forces.
void ContactForces::step_back(uint32_t strand, uint32_t segment) const {
  if (batch.at(strand, segment, simd::kRodFree) == 0) return;
  const double way = to.ways_[strand];
  const auto row = [&](uint32_t field) { return to.scratch_row(batch, strand, segment, field); };
  for (uint32_t k = 0; k < 3; ++k) {
    *row(simd::kRodMove + k) = static_cast<float>(way * static_cast<double>(*row(simd::kRodFreeMove + k)));
  }
  turn_part(strand, segment, simd::kRodFreeTurn);
  for (uint32_t k = 0; k < 6; ++k) *row(simd::kRodForceNow + k) = 0;
}

// Strands that would start deep in something start where they first touch it: an iteration that is cut short,
// by its cap or by how far segments may turn in it, then leaves them in front of it, slower, not behind.
void ContactForces::begin() const noexcept {
  for (Contact& c : contacts()) look(&c);
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
  assemble();
}

// Takes back what of the last iteration lies beyond the strand's way.
void ContactForces::take_back(uint32_t strand) const {
  const auto row = [&](uint32_t i, uint32_t field) { return to.scratch_row(batch, strand, i, field); };
  const auto change = [&](uint32_t i, uint32_t k) {
    return static_cast<double>(*row(i, simd::kRodImpulse + k));
  };
  const double taken = static_cast<double>(lane(strand, simd::kLaneShare)), way = to.ways_[strand];
  const double back = taken * (1 - way);
  const auto less = [&](float* value, double by) {
    *value = static_cast<float>(static_cast<double>(*value) - by);
  };
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    if (batch.at(strand, i, simd::kRodFree) != 0) {
      Turn q;
      for (uint32_t k = 0; k < 4; ++k) q[k] = static_cast<double>(*row(i, simd::kRodNow + k));
      const double half = 0.5 * taken;
      const Turn whole = {half * change(i, 3), half * change(i, 4), half * change(i, 5), 1};
      const Turn part = {way * whole[0], way * whole[1], way * whole[2], 1};
      q = normalised(product(product(q, conjugate(whole)), part));
      for (uint32_t k = 0; k < 3; ++k) less(row(i, simd::kRodMove + k), back * change(i, k));
      for (uint32_t k = 0; k < 4; ++k) *row(i, simd::kRodNow + k) = static_cast<float>(q[k]);
    }
    for (uint32_t k = 0; batch.slots_[i] > 0 && k < 6; ++k) {
      less(row(i, simd::kRodForceNow + k), back * static_cast<double>(*row(i, simd::kRodMiss + k)));
    }
  }
}

// The fewer are left to push out again what an iteration goes into, the less deep it may go: the last no
// deeper than is left alone, each before it twice as deep.
double ContactForces::deep_after(uint32_t left) const {
  const double last = kLeftAlone * static_cast<double>(to.settings_.tolerance);
  return std::min(kDeep, std::ldexp(last, static_cast<int>(std::min(left, 32u))));
}

// No iteration goes deep, or deeper, into anything: ways end there.
void ContactForces::stop_at_new_contacts(uint32_t left) const {
  const double deep = deep_after(left);
  std::fill(to.ways_ + first_strand(), to.ways_ + end_strand(), 1.0);
  bool any = false;
  for (const Contact& c : contacts()) {
    if (!(c.open_before_m > 0) && c.allowed_m < 0) continue;  // it began deep
    const double most = c.open_before_m > 0 ? deep : kAcross;
    if (!iterated(c) || !(c.open_m < -most * c.scale_m) || c.open_m >= c.open_before_m) continue;
    shorten(c, c.open_before_m, deep);
    any = true;
  }
  if (!any) return;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    if (to.ways_[s] < 1 && to.iterated_[s]) take_back(s);
  }
  for (Contact& c : contacts()) {
    if (stepped_back(c)) look(&c);
  }
}

uint32_t ContactForces::settle(uint32_t left) const noexcept {
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    to.iterated_[s] = to.turning_[s] | to.pending_[s];
    to.turning_[s] = active(s) != 0;
    to.pending_[s] = 0;
    to.misses_[s] = to.presses_[s] = 0;
  }
  for (Contact& c : contacts()) {
    if (!iterated(c)) continue;
    c.open_before_m = c.open_m;
    c.slip_before_m = c.slip_m;
    look(&c);
  }
  find_felt();
  stop_at_new_contacts(left);
  for (Contact& c : contacts()) {
    if (!iterated(c) || take_over(&c)) continue;
    to.pending_[c.sides[0].strand] = 1;
    if (c.has_two_rods()) to.pending_[c.sides[1].strand] = 1;
  }
  uint32_t count = 0;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    to.pending_[s] |= to.misses_[s] > static_cast<double>(to.settings_.tolerance) * to.presses_[s];
    active(s) = to.turning_[s] | to.pending_[s] ? 1.0f : 0.0f;
    count += active(s) != 0;
  }
  if (count > 0) assemble();
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

void ContactForces::hold(uint32_t strand, uint32_t segment) const {
  if (batch.at(strand, segment, simd::kRodFree) == 0) return;
  const double way = to.ways_[strand], l = static_cast<double>(batch.units_[strand].length_m);
  for (uint32_t k = 0; k < 3; ++k) {
    float& move = *to.scratch_row(batch, strand, segment, simd::kRodMove + k);
    move = static_cast<float>(way * static_cast<double>(move) + (1 - way) * to.carries_[strand][k] / l);
  }
  turn_part(strand, segment, simd::kRodNow);
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

// Rows that an iteration used up become zero.
void ContactForces::clear() const noexcept {
  const size_t rows = size_t{simd::kRodContactRows} * batch.width_;
  for (uint32_t k = 0; k < to.touched_count_; ++k) {
    std::fill_n(to.rows_ + to.touched_list_[k] * rows, rows, 0.0f);
    to.touched_[to.touched_list_[k]] = 0;
  }
  to.touched_count_ = 0;
}

void ContactForces::assemble() const {
  clear();
  for (uint32_t s = first_strand(); s < end_strand(); ++s)
    lane(s, simd::kLaneLargestShare) = simd::kRodLargestShare;
  for (const Contact& c : contacts()) add(c);
}

// The forces that the last iteration found, not what a further one would make of their gaps: at a gain of a
// thousand masses that would be rounding.
void ContactForces::assemble_ended() const {
  clear();
  for (Contact c : contacts()) {
    c.open_m = 0;
    c.slip_m = {};
    add(c);
  }
}

void ContactForces::add(const Contact& c) const {
  const ContactForce f = forces_of(c);
  if (!f.active) return;
  for (size_t side = 0; side < 2; ++side) {
    const Contact::Side& s = c.sides[side];
    if (s.segment == kNoSegment || !(s.stiffness_kg > 0)) continue;
    if (!(to.turning_[s.strand] | to.pending_[s.strand])) continue;
    const Vector force = scaled_sum(f.press, c.normal, f.drag);
    lane(s.strand, simd::kLaneLargestShare) = 1;
    add_to_side(c, side, f, side == 0 ? force : scaled(-1, force));
  }
}

float* ContactForces::touched_rows(uint32_t strand, uint32_t segment) const {
  const uint32_t group = strand / batch.width_ - to.range_.first_group;
  const uint32_t place = group * batch.segment_count_ + batch.slots_[segment];
  if (!to.touched_[place]) {
    to.touched_[place] = 1;
    to.touched_list_[to.touched_count_++] = place;
  }
  return to.rows_ + size_t{place} * simd::kRodContactRows * batch.width_ + strand % batch.width_;
}

// J^T K J and J^T force of a side's point, K = pressed n n^T + held (1 - n n^T), J = (1, -[arm] R): in units
// of the strand's own.
void ContactForces::add_to_side(const Contact& c, size_t side, const ContactForce& f,
                                const Vector& force) const {
  const Contact::Side& s = c.sides[side];
  const double pressed = s.stiffness_kg, held = f.across * pressed, along_held = f.along * pressed;
  const RodBatch::Units& units = batch.units_[s.strand];
  const double m = units.mass_kg, l = units.length_m;
  const Axes own = axes_of(turn_now(s));
  const Vector arm = scaled(1 / l, scaled_sum(s.radius_m, c.normal, scaled(s.along_m, own.z)));
  const Vector moves[6] = {{1, 0, 0},         {0, 1, 0},         {0, 0, 1},
                           cross(own.x, arm), cross(own.y, arm), cross(own.z, arm)};
  float* rows = touched_rows(s.strand, s.segment);
  const auto put = [&](size_t row, double value) { rows[row * batch.width_] += static_cast<float>(value); };
  for (size_t r = 0; r < 6; ++r) {
    const double along = dot(moves[r], c.normal);
    const Vector held_all =
        scaled_sum((along_held - held) * dot(moves[r], f.direction), f.direction, scaled(held, moves[r]));
    const Vector stiff = scaled(1 / m, scaled_sum((pressed - held) * along, c.normal, held_all));
    for (size_t k = 0; k <= r; ++k) put(simd::kContactMatrix + triangle(r, k), dot(stiff, moves[k]));
    put(simd::kContactForce + r, dot(force, moves[r]) / (m * l));
  }
}

}  // namespace sinew::rods

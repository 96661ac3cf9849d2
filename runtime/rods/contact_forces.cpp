// contact_forces.cpp  The augmented Lagrangian's forces, and their rows for the rods' own iteration.
#include "rods/contact_forces.hpp"

#include <algorithm>
#include <limits>

namespace sinew::rods {
namespace {

constexpr size_t triangle(size_t row, size_t column) { return row * (row + 1) / 2 + column; }

struct Forces {
  double press;
  Vector drag;
  double held;  // drag over what it would be without the limit
};

// Of friction Macklin et al. 2014, Eq. 24: along the slip, at most friction times the pressing force.
Forces forces_of(const Contact& c) {
  Forces f = {std::max(0.0, c.force - c.gain_kg * c.open_m), scaled_sum(-c.gain_kg, c.slip_m, c.drag), 1};
  const double most = c.friction * f.press, size = length(f.drag);
  if (size > most) {
    f.held = most / size;
    f.drag = scaled(f.held, f.drag);
  }
  if (!(most > 0)) f = {f.press, {}, 0};
  return f;
}

}  // namespace

uint32_t ContactForces::end_strand() const {
  return std::min(batch.strand_count_, first_strand() + to.range_.groups * batch.width_);
}

float& ContactForces::active(uint32_t strand) const {
  const size_t group = strand / batch.width_;
  return batch.lanes_[(group * simd::kLaneFields + simd::kLaneActive) * batch.width_ + strand % batch.width_];
}

ContactForces::Now ContactForces::now(const Contact& c, size_t side) const {
  const Contact::Side& s = c.sides[side];
  if (s.segment == kNoSegment) return {c.obstacle_move, c.obstacle_move, {}, {}, {}};
  const auto row = [&](uint32_t field) { return to.scratch_row(batch, s.strand, s.segment, field); };
  const size_t w = batch.width_;
  const float *q = row(simd::kRodNow), *d = row(simd::kRodMove);
  const Turn turn = {q[0], q[w], q[2 * w], q[3 * w]};
  Now out = {{}, {}, turned(turn, {1, 0, 0}), turned(turn, {0, 1, 0}), turned(turn, {0, 0, 1})};
  const Vector move = scaled(batch.units_[s.strand].length_m, {d[0], d[w], d[2 * w]});
  out.move = scaled_sum(s.along_m, difference(out.z, s.axis), move);
  Turn before;
  for (uint32_t k = 0; k < 4; ++k) before[k] = batch.at(s.strand, s.segment, simd::kRodTurn + k);
  const Turn by = product(conjugate(before), turn);
  const double roll = by[3] < 0 ? -2 * by[2] : 2 * by[2];
  out.surface_move = scaled_sum(roll * s.radius_m, cross(out.z, c.normal), out.move);
  return out;
}

// Gap and slip at the iterate. A strand that is lost touches nothing: others are not to be lost with it.
void ContactForces::look(Contact* c) const {
  const Now a = now(*c, 0), b = now(*c, 1);
  c->open_m = c->gap_m + dot(c->normal, difference(a.move, b.move)) - c->allowed_m;
  c->slip_m = across(difference(a.surface_move, b.surface_move), c->normal);
  if (std::isfinite(c->open_m) && finite(c->slip_m)) return;
  c->open_m = std::numeric_limits<double>::max();
  c->force = 0;
  c->slip_m = c->drag = {};
}

bool ContactForces::iterated(const Contact& c) const {
  return to.iterated_[c.sides[0].strand] || (c.has_two_rods() && to.iterated_[c.sides[1].strand]);
}

// Looks, and marks the strands of a contact that has opened or closed by more than its tolerance.
void ContactForces::find_change(Contact* c) const {
  const double open = c->open_m;
  const Vector slip = c->slip_m;
  look(c);
  c->moved_m = std::max(std::fabs(c->open_m - open),
                        c->friction > 0 ? length(difference(c->slip_m, slip)) : 0.0);
  const double press = forces_of(*c).press, before = std::max(0.0, c->force - c->gain_kg * open);
  if ((press > 0) == (before > 0) || std::max(press, before) < tolerance_m(*c) * c->gain_kg) return;
  to.changed_[c->sides[0].strand] = 1;
  if (c->has_two_rods()) to.changed_[c->sides[1].strand] = 1;
}

double ContactForces::tolerance_m(const Contact& c) const {
  return static_cast<double>(to.settings_.tolerance) * c.scale_m;
}

// Returns whether the contact is as exact as wanted.
bool ContactForces::take_over(Contact* c) const {
  const double force = c->force;
  const Vector drag = c->drag;
  const Forces f = forces_of(*c);
  if (to.changed_[c->sides[0].strand] || (c->has_two_rods() && to.changed_[c->sides[1].strand])) return false;
  c->force = f.press;
  c->drag = f.drag;
  if (!(force > 0) && !(f.press > 0)) return true;
  const double off = std::max(std::fabs(f.press - force), length(difference(f.drag, drag))) / c->gain_kg;
  return std::max(off, c->moved_m) <= tolerance_m(*c);
}

void ContactForces::begin() const noexcept {
  for (uint32_t i = to.first_contact_; i < to.contact_count_; ++i) look(&to.contacts_[i]);
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    to.turning_[s] = 0;
    to.pending_[s] = 1;
  }
  assemble();
}

uint32_t ContactForces::settle() const noexcept {
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    to.iterated_[s] = to.turning_[s] | to.pending_[s];
    to.turning_[s] = active(s) != 0;
    to.pending_[s] = to.changed_[s] = 0;
  }
  const std::span<Contact> contacts(to.contacts_ + to.first_contact_, to.contact_count_ - to.first_contact_);
  for (Contact& c : contacts) {
    if (iterated(c)) find_change(&c);
  }
  for (Contact& c : contacts) {
    if (!iterated(c) || take_over(&c)) continue;
    to.pending_[c.sides[0].strand] = 1;
    if (c.has_two_rods()) to.pending_[c.sides[1].strand] = 1;
  }
  uint32_t count = 0;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    active(s) = to.turning_[s] | to.pending_[s] ? 1.0f : 0.0f;
    count += active(s) != 0;
  }
  if (count > 0) assemble();
  return count;
}

uint32_t ContactForces::end() const noexcept {
  uint32_t count = 0;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    active(s) = to.turning_[s] ? 1.0f : 0.0f;
    count += to.pending_[s];
  }
  return count;
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
  for (uint32_t i = to.first_contact_; i < to.contact_count_; ++i) add(to.contacts_[i]);
}

void ContactForces::add(const Contact& c) const {
  const Forces f = forces_of(c);
  if (!(f.press > 0)) return;
  for (size_t side = 0; side < 2; ++side) {
    const Contact::Side& s = c.sides[side];
    if (s.segment == kNoSegment || !(s.stiffness_kg > 0)) continue;
    if (!(to.turning_[s.strand] | to.pending_[s.strand])) continue;
    const Vector force = scaled_sum(f.press, c.normal, f.drag);
    add_to_side(c, side, side == 0 ? force : scaled(-1, force), s.stiffness_kg, f.held * s.stiffness_kg);
  }
}

float* ContactForces::touched_rows(uint32_t strand, uint32_t segment) const {
  const uint32_t group = strand / batch.width_ - to.range_.first_group;
  const uint32_t place = group * batch.segment_count_ + segment;
  if (!to.touched_[place]) {
    to.touched_[place] = 1;
    to.touched_list_[to.touched_count_++] = place;
  }
  return to.rows_ + size_t{place} * simd::kRodContactRows * batch.width_ + strand % batch.width_;
}

// J^T K J and J^T force of a side's point, K = pressed n n^T + held (1 - n n^T), J = (1, -[arm] R): in units
// of the strand's own.
void ContactForces::add_to_side(const Contact& c, size_t side, const Vector& force, double pressed,
                                double held) const {
  const Contact::Side& s = c.sides[side];
  const RodBatch::Units& units = batch.units_[s.strand];
  const double m = units.mass_kg, l = units.length_m;
  const Now own = now(c, side);
  const Vector arm = scaled(1 / l, scaled_sum(s.radius_m, c.normal, scaled(s.along_m, own.z)));
  const Vector moves[6] = {{1, 0, 0},         {0, 1, 0},         {0, 0, 1},
                           cross(own.x, arm), cross(own.y, arm), cross(own.z, arm)};
  float* rows = touched_rows(s.strand, s.segment);
  const auto put = [&](size_t row, double value) { rows[row * batch.width_] += static_cast<float>(value); };
  for (size_t r = 0; r < 6; ++r) {
    const double along = dot(moves[r], c.normal);
    const Vector stiff =
        scaled(1 / m, scaled_sum((pressed - held) * along, c.normal, scaled(held, moves[r])));
    for (size_t k = 0; k <= r; ++k) put(simd::kContactMatrix + triangle(r, k), dot(stiff, moves[k]));
    put(simd::kContactForce + r, dot(force, moves[r]) / (m * l));
  }
}

}  // namespace sinew::rods

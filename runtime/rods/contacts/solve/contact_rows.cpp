// contact_rows.cpp  Contacts' forces and stiffness as rows of the rods' own linear system.
#include <algorithm>

#include "rods/contacts/solve/contact_lanes.hpp"

namespace sinew::rods {
namespace {

constexpr size_t triangle(size_t row, size_t column) { return row * (row + 1) / 2 + column; }

}  // namespace

// Rows that an iteration used up become zero.
void ContactForces::clear() const noexcept {
  const size_t rows = size_t{simd::kRodContactRows} * batch.width_;
  for (uint32_t k = 0; k < to.forces_on_.touched_count; ++k) {
    std::fill_n(to.forces_on_.rows + to.forces_on_.touched_list[k] * rows, rows, 0.0f);
    to.forces_on_.touched[to.forces_on_.touched_list[k]] = 0;
  }
  to.forces_on_.touched_count = 0;
}

void ContactForces::assemble() const noexcept {
  clear();
  for (const uint32_t s : going_strands()) lane(s, simd::kLaneLargestShare) = simd::kRodLargestShare;
  ContactPushes pushes(*this);
  for (const uint32_t i : going_contacts()) pushes.add(to.found_.contacts[i]);
  pushes.end();
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
  if (!goes_on(c)) return;
  const ContactForce f = forces_of(c);
  if (!f.active) return;
  for (size_t side = 0; side < 2; ++side) {
    const Contact::Side& s = c.sides[side];
    if (s.segment == kNoSegment || !(s.stiffness_kg > 0) || !goes_on(s.strand)) continue;
    const Vector force = scaled_sum(f.press, c.normal, f.drag);
    lane(s.strand, simd::kLaneLargestShare) = 1;
    add_to_side(c, side, f, side == 0 ? force : scaled(-1, force));
  }
}

float* ContactForces::touched_rows(uint32_t strand, uint32_t segment) const {
  const uint32_t at = to.seat(strand);
  const uint32_t place = batch.group_of(at) * batch.segment_count_ + batch.slots_[segment];
  if (!to.forces_on_.touched[place]) {
    to.forces_on_.touched[place] = 1;
    to.forces_on_.touched_list[to.forces_on_.touched_count++] = place;
  }
  return to.forces_on_.rows + size_t{place} * simd::kRodContactRows * batch.width_ + batch.lane_of(at);
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

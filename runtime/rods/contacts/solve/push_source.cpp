// push_source.cpp  What a step's contacts did to the obstacles of a contact source.
#include <algorithm>

#include "rods/contacts/solve/contact_forces.hpp"

namespace sinew::rods {
namespace {

constexpr double kLeastShare = 1e-6;

}  // namespace

// What the iteration's linear system made of each hit's force, as far as the iteration was taken, before its
// contact is looked at again.
void ContactForces::find_felt() const {
  for (uint32_t i = to.places_.range.first_hit; i < to.places_.range.end_hit; ++i) {
    TakenHit& taken = to.asked_.taken[i];
    if (taken.contact == kNoContact) continue;
    const Contact& c = to.found_.contacts[taken.contact];
    if (!iterated(c)) continue;
    const ContactForce f = forces_of(c, c.open_before_m, c.slip_before_m);
    const double share = share_of(c), per_share = 1 / std::max(share, kLeastShare);
    const double press = f.press - per_share * c.gain_kg * (c.open_m - c.open_before_m);
    const Vector slipped = scaled(per_share, difference(c.slip_m, c.slip_before_m));
    const Vector drag = drag_after(c, f, slipped);
    const Vector whole = f.active ? scaled_sum(press, c.normal, drag) : Vector{};
    taken.felt = between(taken.felt, whole, share);
  }
}

// What all that pulled and pushed the strand's segments came to at least, times the step's square. Of a
// strand that nothing holds its joints' forces cancel.
double ContactForces::moved_kg_m(uint32_t strand) const {
  double sizes = 0;
  Vector whole = {};
  bool held = false;
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    held = held || batch.at(strand, i, simd::kRodFree) == 0;
    if (batch.at(strand, i, simd::kRodFree) == 0) continue;
    const auto by = [&](uint32_t k) {
      return static_cast<double>(*to.scratch_row(batch, strand, i, simd::kRodMove + k)) -
             static_cast<double>(*to.scratch_row(batch, strand, i, simd::kRodFreeMove + k));
    };
    const Vector moved =
        scaled(static_cast<double>(batch.at(strand, i, simd::kRodMass)), {by(0), by(1), by(2)});
    sizes += length(moved);
    whole = sum(whole, moved);
  }
  return (held ? sizes : length(whole)) * static_cast<double>(batch.units_[strand].mass_kg) *
         static_cast<double>(batch.units_[strand].length_m);
}

// Forces that did not settle are of any size.
void ContactForces::limit_felt() const {
  std::fill(to.asked_.pushes + first_strand(), to.asked_.pushes + end_strand(), 0.0);
  const auto strand_of = [&](uint32_t i) {
    return to.found_.contacts[to.asked_.taken[i].contact].sides[0].strand;
  };
  const auto counts = [&](uint32_t i) {
    if (to.asked_.taken[i].contact == kNoContact) return false;
    const uint32_t s = strand_of(i);
    return (to.progress_.turning[s] | to.progress_.pending[s]) != 0;
  };
  for (uint32_t i = to.places_.range.first_hit; i < to.places_.range.end_hit; ++i) {
    if (counts(i)) to.asked_.pushes[strand_of(i)] += length(to.asked_.taken[i].felt);
  }
  for (uint32_t i = to.places_.range.first_hit; i < to.places_.range.end_hit; ++i) {
    if (!counts(i)) continue;
    const double most = moved_kg_m(strand_of(i)), all = to.asked_.pushes[strand_of(i)];
    if (!(all <= most)) to.asked_.taken[i].felt = scaled(most / all, to.asked_.taken[i].felt);
  }
}

void ContactForces::place_hits() const noexcept {
  if (to.places_.range.end_hit > to.places_.range.first_hit) limit_felt();
  for (uint32_t i = to.places_.range.first_hit; i < to.places_.range.end_hit; ++i) {
    TakenHit& taken = to.asked_.taken[i];
    if (taken.contact == kNoContact) continue;
    const Contact& c = to.found_.contacts[taken.contact];
    const Contact::Side& s = c.sides[0];
    const RodBatch::Units& units = batch.units_[s.strand];
    const Vector middle = scaled_sum(static_cast<double>(units.length_m), batch.place(s.strand, s.segment),
                                     {units.origin_m[0], units.origin_m[1], units.origin_m[2]});
    const Vector on_axis = sum(scaled_sum(s.along_m, s.axis, middle), move(c, 0));
    taken.point_m = scaled_sum(s.radius_m, c.normal, on_axis);
  }
}

void RodCollider::push(float dt_s) const noexcept {
  for (uint32_t i = 0; i < asked_.hit_count; ++i) {
    const Vector impulse = scaled(-1 / static_cast<double>(dt_s), asked_.taken[i].felt);
    if (!(dot(impulse, impulse) > 0) || !finite(impulse) || !finite(asked_.taken[i].point_m)) continue;
    const Vector& p = asked_.taken[i].point_m;
    asked_.source->push(
        asked_.hits[i], {p[0] + asked_.origin_m[0], p[1] + asked_.origin_m[1], p[2] + asked_.origin_m[2]},
        {static_cast<float>(impulse[0]), static_cast<float>(impulse[1]), static_cast<float>(impulse[2])});
  }
}

}  // namespace sinew::rods

// contact_ways.cpp  How far a strand goes in an iteration before it is deep in something.
#include <algorithm>
#include <cmath>

#include "rods/contacts/solve/contact_forces.hpp"

namespace sinew::rods {
namespace {

constexpr double kDeep = 0.5;    // of a segment's radius
constexpr double kAcross = 1.5;  // the same: next to where two rods' axes cross

}  // namespace

// What share of its way a strand goes before it is deep in something.
void ContactForces::find_ways() const {
  std::fill(to.progress_.ways + first_strand(), to.progress_.ways + end_strand(), 1.0);
  for (const Contact& c : contacts()) {
    if (!(c.open_m < -kDeep * c.scale_m)) continue;
    shorten(c, std::max(c.gap_m - c.allowed_m, 0.0), kDeep);
  }
}

bool ContactForces::stepped_back(const Contact& c) const {
  return to.progress_.ways[c.sides[0].strand] < 1 ||
         (c.has_two_rods() && to.progress_.ways[c.sides[1].strand] < 1);
}

// A way that opened at `start` and leads deep into a contact ends where the contact has just closed; one that
// began in it where it is deep, or at once.
void ContactForces::shorten(const Contact& c, double start, double deep) const {
  const double least = (start > 0 ? 0.25 * deep : kAcross) * c.scale_m;
  const double way = std::max(0.0, start + least) / (start - c.open_m);
  to.progress_.ways[c.sides[0].strand] = std::min(to.progress_.ways[c.sides[0].strand], way);
  if (c.has_two_rods())
    to.progress_.ways[c.sides[1].strand] = std::min(to.progress_.ways[c.sides[1].strand], way);
}

// The iterate's turn: progress_.ways's share of the way from the step's start to the turn in `field`.
void ContactForces::turn_part(uint32_t strand, uint32_t segment, uint32_t field) const {
  const double way = to.progress_.ways[strand];
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
  const double way = to.progress_.ways[strand];
  const auto row = [&](uint32_t field) { return to.scratch_row(batch, strand, segment, field); };
  for (uint32_t k = 0; k < 3; ++k) {
    *row(simd::kRodMove + k) = static_cast<float>(way * static_cast<double>(*row(simd::kRodFreeMove + k)));
  }
  turn_part(strand, segment, simd::kRodFreeTurn);
  for (uint32_t k = 0; k < 6; ++k) *row(simd::kRodForceNow + k) = 0;
}

// Takes back what of the last iteration lies beyond the strand's way.
void ContactForces::take_back(uint32_t strand) const {
  const auto row = [&](uint32_t i, uint32_t field) { return to.scratch_row(batch, strand, i, field); };
  const auto change = [&](uint32_t i, uint32_t k) {
    return static_cast<double>(*row(i, simd::kRodImpulse + k));
  };
  const double taken = static_cast<double>(lane(strand, simd::kLaneShare)), way = to.progress_.ways[strand];
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
  lane(strand, simd::kLaneShare) = static_cast<float>(way * taken);
}

// How deep an iteration may go, of a radius, into what it did not touch: the fewer are left to push it out
// again, the less. The last no deeper than is left alone, each before it twice as deep, up to kDeep.
double ContactForces::deep_after(uint32_t left) const {
  const double last = kLeftAlone * static_cast<double>(to.settings_.tolerance);
  return std::min(kDeep, std::ldexp(last, static_cast<int>(std::min(left, 32u))));
}

// No iteration goes deep into what it did not touch, nor deeper into what it did: ways end there.
void ContactForces::stop_at_new_contacts(uint32_t left) const {
  const double deep = deep_after(left);
  for (const uint32_t s : going_strands()) to.progress_.ways[s] = 1;
  bool any = false;
  for (const uint32_t i : going_contacts()) {
    const Contact& c = to.found_.contacts[i];
    if (!(c.open_before_m > 0) && c.allowed_m < 0) continue;  // it began deep
    const double most = c.open_before_m > 0 ? deep : kAcross;
    if (!iterated(c) || !(c.open_m < -most * c.scale_m) || c.open_m >= c.open_before_m) continue;
    shorten(c, c.open_before_m, deep);
    any = true;
  }
  if (!any) return;
  for (const uint32_t s : going_strands()) {
    if (to.progress_.ways[s] < 1 && to.progress_.iterated[s]) take_back(s);
  }
  for (const uint32_t i : going_contacts()) {
    if (stepped_back(to.found_.contacts[i])) look(&to.found_.contacts[i]);
  }
}

void ContactForces::hold(uint32_t strand, uint32_t segment) const {
  if (batch.at(strand, segment, simd::kRodFree) == 0) return;
  const double way = to.progress_.ways[strand], l = static_cast<double>(batch.units_[strand].length_m);
  for (uint32_t k = 0; k < 3; ++k) {
    float& move = *to.scratch_row(batch, strand, segment, simd::kRodMove + k);
    move =
        static_cast<float>(way * static_cast<double>(move) + (1 - way) * to.progress_.carries[strand][k] / l);
  }
  turn_part(strand, segment, simd::kRodNow);
}

}  // namespace sinew::rods

// contact_laws.cpp  What a contact's force becomes after an iteration: pressing, sticking, sliding, exact.
#include <algorithm>

#include "kernels/rod_contacts/rod_force_job.hpp"
#include "rods/contacts/solve/contact_forces.hpp"

namespace sinew::rods {
namespace {

// Of a segment's length, what of a gap no iteration closes: a turn in float, at half of it.
constexpr double kRounding = 3e-8;
constexpr double kAtLimit = 0.99;  // of the limit: less is more than forces miss it by where they are exact

}  // namespace

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
  c->state = ++c->changes > simd::kMostFrictionChanges ? Friction::kEither
             : slides                                  ? Friction::kSticks
                                                       : Friction::kSlides;
  return true;
}

// Of what slipped so, from the drag it had.
Vector ContactForces::taken_drag(const Contact& c, const Vector& slip, bool comes_to_rest) const {
  if (!comes_to_rest) return forces_of(c, 0, slip).drag;
  const double size = length(c.drag);
  return size > c.limit ? scaled(c.limit / size, c.drag) : c.drag;
}

// The gain makes a force of each gap's rounding.
double ContactForces::rounding_kg_m(const Contact& c) const {
  return kRounding * static_cast<double>(batch.units_[c.sides[0].strand].length_m) * c.gain_kg;
}

// What the forces that a system came to miss contact's laws by, kg m: a pull, drag that is more than friction
// gives, or that does not go against the slip. Nothing where nothing stuck and the iteration moved nothing:
// where friction is at its limit and nothing slides, drags are not unique.
double ContactForces::law_miss(const Contact& c, const Before& before) const {
  const double moved =
      std::max(std::fabs(c.open_m - c.open_before_m), length(difference(c.slip_m, c.slip_before_m)));
  const bool sticks = before.state == Friction::kSticks;
  if (!sticks && moved <= nothing_m(c)) return 0;
  const double pull = std::max(0.0, c.gain_kg * c.open_m - before.force);
  const double rounding = rounding_kg_m(c);
  if (!(c.friction > 0)) return std::max(0.0, pull - rounding);
  const Vector drag = drag_after(c, before.linearised, difference(c.slip_m, c.slip_before_m));
  const double limit = c.friction * c.force;
  Vector lawful = sticks ? drag : scaled_sum(-c.gain_kg, c.slip_m, drag);
  const double size = length(lawful);
  if (size > limit) lawful = scaled(limit / size, lawful);
  return std::max(0.0, pull + length(difference(lawful, drag)) - rounding);
}

// Whether gap and slip between rods, which iterate in turn, are as exact as wanted: by what an iteration
// still changes.
bool ContactForces::is_exact(const Contact& c, const Before& before) const {
  const double off =
      std::max(std::fabs(c.force - before.force), length(difference(c.drag, before.drag))) / c.gain_kg;
  const double moved = std::max(std::fabs(c.open_m - c.open_before_m),
                                c.friction > 0 ? length(difference(c.slip_m, c.slip_before_m)) : 0.0);
  return std::max(off, c.slowness * moved) <= tolerance_m(c);
}

// Of a strand together, against what friction gives, or what presses where there is none: small forces next
// to large ones need not be as exact.
void ContactForces::add_miss(const Contact& c, double miss) const {
  for (const Contact::Side& side : c.sides) {
    if (side.segment == kNoSegment) continue;
    to.progress_.misses[side.strand] += miss;
    to.progress_.presses[side.strand] += (c.friction > 0 ? c.friction : 1.0) * c.force;
  }
}

// The forces of an iteration, as far as it was taken: with the whole gap, one left by a half step would be
// pressed out again by a thousand masses. The limit is of a force that a system came to, not of what a gap
// asks for, a hundred times that. Two contacts at right angles throw each other's force to and fro, what one
// drags presses the other: errors turn by i friction an iteration, and of all shares of a change
// 1 / (1 + friction^2) leaves least of them. Returns whether the contact is as exact as wanted.
bool ContactForces::take_over(Contact* c) const {
  if (!is_active(*c, c->open_before_m)) return begin_anew(c);
  const Before before = {c->force, c->drag, c->state, forces_of(*c, c->open_before_m, c->slip_before_m)};
  const double left = 1 - share_of(*c);
  const Vector slip = scaled_sum(-left, c->slip_before_m, c->slip_m);
  c->force = std::max(0.0, c->force - c->gain_kg * (c->open_m - left * c->open_before_m));
  c->limit += (c->friction * c->force - c->limit) / (1 + c->friction * c->friction);
  const bool changed = c->force > 0 && update_friction(c, slip);
  const bool rests = changed && before.state == Friction::kSlides;
  c->drag = taken_drag(*c, slip, rests);
  add_miss(*c, law_miss(*c, before));
  return is_exact(*c, before);
}

// At its limit, and on its way against its drag where the step begins.
bool ContactForces::slid(const Contact& c) const {
  const double drag = length(c.drag);
  return drag >= kAtLimit * c.limit && -dot(c.slip_m, c.drag) > nothing_m(c) * drag;
}

// What slid goes on, and what is new slides where it is too fast to be held; what is open has no friction.
void ContactForces::begin_friction(Contact* c) const {
  const bool known = c->force > 0;
  if (!known && c->open_m >= 0) return;
  c->limit = known ? c->friction * c->force : limit_of_new(*c);
  const bool slides = known ? slid(*c) : mass_kg(*c) * length(c->slip_m) > c->limit;
  c->state = slides ? Friction::kSlides : Friction::kSticks;
}

}  // namespace sinew::rods

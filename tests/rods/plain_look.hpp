// plain_look.hpp  Where a contact with an obstacle is at an iterate, one at a time, as contact_forces.cpp has
// it.
#pragma once
#include "rods/contacts/contact.hpp"
#include "rods/turn.hpp"

namespace sinew::test {

struct Iterate {
  double length_m;
  float move[3], now[4], before[4];
};
struct Looked {
  double open_m;
  rods::Vector slip_m;
};
inline Looked plain_look(const rods::Contact& c, const Iterate& at) {
  const rods::Contact::Side& s = c.sides[0];
  const rods::Turn now = rods::turn_of(at.now),
                   by = rods::product(rods::conjugate(rods::turn_of(at.before)), now);
  const rods::Axes own = rods::axes_of(now);
  const rods::Vector move = rods::scaled_sum(s.along_m, rods::difference(own.z, s.axis),
                                             rods::scaled(at.length_m, rods::vector_of(at.move)));
  const double open = c.gap_m + rods::dot(c.normal, rods::difference(move, c.obstacle_move)) - c.allowed_m;
  if (!rods::is_active(c, open) && !rods::is_active(c, c.open_before_m)) return {open, {}};
  const rods::Vector turned = rods::scaled(
      by[3] < 0 ? -2 : 2,
      rods::scaled_sum(by[0], own.x, rods::scaled_sum(by[1], own.y, rods::scaled(by[2], own.z))));
  const rods::Vector surface = rods::scaled_sum(s.radius_m, rods::cross(turned, c.normal), move);
  return {open, rods::across(rods::difference(surface, c.obstacle_move), c.normal)};
}

}  // namespace sinew::test

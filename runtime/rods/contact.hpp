// contact.hpp  One contact of a step: two points, a normal and the force between them.
//
//   gap    C = gap_m + n . (move_a - move_b) - allowed_m >= 0
//   force  p = max(0, force - gain C), an augmented Lagrangian (Hestenes 1969, Powell 1969)
//   slip   s = what of move_a - move_b, at the surfaces, is across n (Macklin et al. 2014, Section 6.1)
//   drag   t = drag - gain s, shortened to friction p
// After each iteration force <- p and drag <- t; what is iterated to has C = 0 or p = 0, s = 0 or |t| =
// friction p, exactly, whatever the gain and whatever it began with. The gain only says how fast: an
// iteration divides force's error by 1 + gain w, w the inverse mass that the contact feels. Normal and points
// belong to the step: the constraint is linear in the moves, and an iteration of rods that touch converges as
// one of rods that do not. Normals of the iterate were rejected: on a thin obstacle hit at speed they turn
// faster than Newton follows.
#pragma once
#include <algorithm>
#include <cstdint>

#include "rods/vector.hpp"

namespace sinew::rods {

inline constexpr uint32_t kNoSegment = ~0u;

// Masses in kg, forces times the step's square (kg m), lengths in m.
struct Contact {
  // One of two bodies; the second may be an obstacle, which has no segment.
  struct Side {
    uint32_t strand, segment;
    double along_m;       // from the segment's middle
    double radius_m;      // signed: from the axis to the surface along the normal
    double stiffness_kg;  // what of the gain the segment's own matrix gets, 0 for one whose pose is given
    Vector axis;          // at the step's start
  };
  uint64_t name;  // the same in the next step: the same contact
  Side sides[2];
  Vector normal;         // from the second to the first
  Vector obstacle_move;  // of the obstacle's point in this step; zero for a rod
  double gap_m;          // at the step's start
  double allowed_m;      // least gap at its end: below zero where penetration is left or pushed out slowly
  double gain_kg;
  double slowness;  // what is left to go, over an iteration's change
  double friction;
  double scale_m;  // the segment's radius, that tolerance and penetration are shares of
  double force;
  Vector drag;
  double open_m;  // C and slip of the last evaluation
  Vector slip_m;
  double open_before_m;  // and of the one before
  Vector slip_before_m;

  bool has_two_rods() const { return sides[1].segment != kNoSegment; }
};

// What a contact does at the last evaluation.
struct ContactForce {
  double press;
  Vector drag;
  double held;  // drag over what it would be without the limit
};

// Of friction Macklin et al. 2014, Eq. 24: along the slip, at most friction times the pressing force.
inline ContactForce forces_of(const Contact& c) {
  ContactForce f = {std::max(0.0, c.force - c.gain_kg * c.open_m), scaled_sum(-c.gain_kg, c.slip_m, c.drag),
                    1};
  const double most = c.friction * f.press, size = length(f.drag);
  if (size > most) {
    f.held = most / size;
    f.drag = scaled(f.held, f.drag);
  }
  if (!(most > 0)) f = {f.press, {}, 0};
  return f;
}

}  // namespace sinew::rods

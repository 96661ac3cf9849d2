// contact.hpp  One contact of a step: two points, a normal and the force between them.
//
//   gap    C = gap_m + n . (move_a - move_b) - allowed_m >= 0
//   force  p = force - gain C where that is active, an augmented Lagrangian (Hestenes 1969, Powell 1969)
//   slip   s = what of move_a - move_b, at the surfaces, is across n (Macklin et al. 2014, Section 6.1)
//   drag   t = drag - gain s, shortened to a limit where it slides
// After each iteration force and drag become what its linear system made of p and t, by the share of its
// change that was taken, and the limit follows friction times that force (contact_laws.cpp). What is
// iterated to has C = 0 or p = 0, s = 0 or |t| = friction p, exactly, whatever the gain and whatever it began
// with. The gain only says how fast: an iteration divides force's error by 1 + gain w, w the inverse mass
// that the contact feels. Normal and points belong to the step: the constraint is linear in the moves, and an
// iteration of rods that touch converges as one of rods that do not. Normals of the iterate were rejected: on
// a thin obstacle hit at speed they turn faster than Newton follows.
#pragma once
#include <algorithm>
#include <cstdint>

#include "rods/vector.hpp"

namespace sinew::rods {

inline constexpr uint32_t kNoSegment = ~0u;

// How friction enters an iteration: with all of the gain; with its limit's force against the slip; or by the
// slip's own size, which comes to either, slowly.
enum class Friction : uint16_t { kSticks, kSlides, kEither };

// A contact's force, of a step of any length.
struct ForceInNewtons {
  double press;
  Vector drag;
};

// Masses in kg, forces times the step's square (kg m), lengths in m.
struct alignas(64) Contact {
  // One of two bodies; the second may be an obstacle, which has no segment.
  struct Side {
    uint32_t strand, segment;
    double along_m;       // from the segment's middle
    double radius_m;      // signed: from the axis to the surface along the normal
    double stiffness_kg;  // what of the gain the segment's own matrix gets, 0 for one whose pose is given
    Vector axis;          // at the step's start
  };
  // What loops over contacts read comes first.
  uint64_t name;  // the same in the next step: the same contact
  // C of the last evaluation, and of the one before or, of what no iteration got near then, a little less.
  double open_m, open_before_m;
  double force;
  double gain_kg;
  double allowed_m;  // least gap at its end: below zero where penetration is left or pushed out slowly
  double scale_m;    // the segment's radius, that tolerance and penetration are shares of
  Friction state;
  bool is_looked_at;  // open_m and slip_m are of the step's first iterate
  bool is_left_out;   // it does not press there, and no iteration got near it
  uint32_t changes;   // of the state in this step
  Side sides[2];
  double friction;
  double limit;          // of drag: friction times the pressing force
  Vector normal;         // from the second to the first
  Vector obstacle_move;  // of the obstacle's point in this step; zero for a rod
  double gap_m;          // at the step's start
  double slowness;       // what is left to go, over an iteration's change
  Vector drag;
  Vector slip_m;  // as open_m
  Vector slip_before_m;
  ForceInNewtons last;  // that the last step came to; 0 where it did not press, or its change is not known

  bool has_two_rods() const { return sides[1].segment != kNoSegment; }
};

// What a contact does at the last evaluation, and how much of the gain holds against slip, along the drag and
// across it.
struct ContactForce {
  double press;
  bool active;
  Vector drag, direction;
  double along, across;
};

// An obstacle's gain over the segment's mass: an iteration divides a contact's error by some hundreds.
inline constexpr double kObstacleGain = 1e3;
// Between rods, over their reduced mass: more would slow down what both do together, less the force. An
// iteration leaves 2/3 of a common motion's error and, of a force's, 1/3 or more where rods are stiff.
inline constexpr double kRodGain = 2;
// Penetration that is left alone, of the tolerance.
inline constexpr double kLeftAlone = 2;
// Of an obstacle's gain, what a gap counts against a force that presses: the segment's own mass lets go where
// the force would not close the gap in the step; all of the gain, of what an iteration leaves open by a
// rounding.
inline constexpr double kLetsGo = 1 / kObstacleGain;

inline bool is_active(const Contact& c, double open_m) {
  return c.force - (c.has_two_rods() ? 1 : kLetsGo) * c.gain_kg * open_m > 0;
}

// Where gap and slip are these. Of friction Macklin et al. 2014, Eq. 24: along the slip, at most the limit.
inline ContactForce forces_of(const Contact& c, double open_m, const Vector& slip_m) {
  const bool active = is_active(c, open_m);
  ContactForce f = {active ? c.force - c.gain_kg * open_m : 0, active, {}, {}, 0, 0};
  const bool sticks = c.state == Friction::kSticks;
  if (!(active && c.friction > 0 && (sticks || c.limit > 0))) return f;
  f.drag = scaled_sum(-c.gain_kg, slip_m, c.drag);
  f.along = f.across = 1;
  const double size = length(f.drag);
  if (sticks || !(size > c.limit)) return f;
  f.across = c.limit / size;
  f.along = c.state == Friction::kSlides ? 0 : f.across;
  f.direction = scaled(1 / size, f.drag);
  f.drag = scaled(c.limit, f.direction);
  return f;
}
inline ContactForce forces_of(const Contact& c) { return forces_of(c, c.open_m, c.slip_m); }

// The drag that forces which were linearised come to where the slip changes.
inline Vector drag_after(const Contact& c, const ContactForce& f, const Vector& change) {
  const double along = (f.along - f.across) * dot(change, f.direction);
  return scaled_sum(-c.gain_kg, scaled_sum(along, f.direction, scaled(f.across, change)), f.drag);
}

}  // namespace sinew::rods

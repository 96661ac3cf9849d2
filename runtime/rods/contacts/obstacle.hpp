// obstacle.hpp  What rods run into: planes, spheres, capsules, and contacts that somebody else found.
//
// All in the world. An obstacle's pose is that at the end of the coming step, and its velocity is what
// brought it there, as with RodBatch::set_target; step() does not move it. `friction` is Coulomb's
// coefficient, 0 or more, finite. `restitution`, 0 to 1: what hits faster than kSlowestRebound_m_s leaves
// with that share of its speed. What an obstacle hits it pushes; nothing pushes an obstacle.
#pragma once
#include <cstdint>
#include <span>

#include "sinew/status.hpp"

namespace sinew::rods {

// Slower contacts do not bounce.
inline constexpr float kSlowestRebound_m_s = 0.2f;

struct ObstacleMotion {
  float linear_m_s[3] = {0, 0, 0};     // finite; of the plane's point, the sphere's or capsule's middle
  float angular_rad_s[3] = {0, 0, 0};  // finite; about it
};

// All space behind it is solid. Swept rods are stopped however fast they are.
struct Plane {
  double point_m[3] = {0, 0, 0};
  float normal[3] = {0, 1, 0};  // unit vector, out of what is solid
  float friction = 0.5f;
  ObstacleMotion motion = {};
  float restitution = 0;
};

struct Sphere {
  double middle_m[3] = {0, 0, 0};
  float radius_m = 0;  // above 0
  float friction = 0.5f;
  ObstacleMotion motion = {};
  float restitution = 0;
};

// Both ends may be the same point: a sphere.
struct Capsule {
  double ends_m[2][3] = {{0, 0, 0}, {0, 0, 0}};  // of the axis
  float radius_m = 0;                            // above 0
  float friction = 0.5f;
  ObstacleMotion motion = {};
  float restitution = 0;
};

// The door for other collision detection: one point of a segment against a half-space, at the step's start.
struct ContactPoint {
  uint32_t strand = 0, segment = 0;   // of a segment whose pose is given: does nothing
  float along = 0;                    // -1 at the segment's beginning, 1 at its end
  double gap_m = 0;                   // from surface to surface, negative in penetration; finite
  float normal[3] = {0, 1, 0};        // unit vector, from the obstacle to the segment
  float velocity_m_s[3] = {0, 0, 0};  // of the obstacle's surface there
  float friction = 0.5f;
  uint32_t name = 0;  // the same in the next step: the same contact, which starts with the force it had
  float restitution = 0;
};

// kInvalidArgument or kNotFinite with kind, index, number and what to do about it.
Status check_obstacle(const Plane& plane, uint32_t index) noexcept;
Status check_obstacle(const Sphere& sphere, uint32_t index) noexcept;
Status check_obstacle(const Capsule& capsule, uint32_t index) noexcept;
Status check_obstacle(const ContactPoint& point, uint32_t index) noexcept;

}  // namespace sinew::rods

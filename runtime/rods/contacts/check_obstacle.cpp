// check_obstacle.cpp  Refuses obstacles that cannot be collided with, by name and place.
#include <cmath>

#include "core/status.hpp"
#include "rods/contacts/obstacle.hpp"

namespace sinew::rods {
namespace {

constexpr double kUnitTolerance = 1e-3;  // of a normal's length

struct Place {
  const char* kind;
  uint32_t index;
};

Status refuse(Place place, const char* name, double value, const char* mend) {
  const StatusCode code = std::isfinite(value) ? StatusCode::kInvalidArgument : StatusCode::kNotFinite;
  return core::make_status(code, "%s %u: %s is %g; %s", place.kind, place.index, name, value, mend);
}

template <class T, size_t kCount>
Status check_finite(Place place, const char* name, const T (&values)[kCount]) {
  for (const T x : values) {
    if (!std::isfinite(x)) return refuse(place, name, static_cast<double>(x), "give finite numbers");
  }
  return {};
}

Status check_radius(Place place, float radius_m) {
  return radius_m > 0 && std::isfinite(radius_m)
             ? Status{}
             : refuse(place, "radius_m", static_cast<double>(radius_m), "give a finite number above 0");
}

Status check_friction(Place place, float friction) {
  return friction >= 0 && std::isfinite(friction)
             ? Status{}
             : refuse(place, "friction", static_cast<double>(friction), "give a finite number, 0 or more");
}

Status check_restitution(Place place, float restitution) {
  return restitution >= 0 && restitution <= 1
             ? Status{}
             : refuse(place, "restitution", static_cast<double>(restitution), "give 0 to 1");
}

Status check_normal(Place place, const float (&n)[3]) {
  const double length = std::hypot(n[0], n[1], n[2]);
  return std::fabs(length - 1) <= kUnitTolerance
             ? Status{}
             : refuse(place, "the length of normal", length, "give a unit vector");
}

template <class Obstacle>
Status check_surface(Place place, const Obstacle& obstacle) {
  const ObstacleMotion& motion = obstacle.motion;
  Status status = check_friction(place, obstacle.friction);
  if (status.ok()) status = check_restitution(place, obstacle.restitution);
  if (status.ok()) status = check_finite(place, "linear_m_s", motion.linear_m_s);
  if (status.ok()) status = check_finite(place, "angular_rad_s", motion.angular_rad_s);
  return status;
}

}  // namespace

Status check_obstacle(const Plane& plane, uint32_t index) noexcept {
  const Place place = {"plane", index};
  Status status = check_finite(place, "point_m", plane.point_m);
  if (status.ok()) status = check_normal(place, plane.normal);
  return status.ok() ? check_surface(place, plane) : status;
}

Status check_obstacle(const Sphere& sphere, uint32_t index) noexcept {
  const Place place = {"sphere", index};
  Status status = check_finite(place, "middle_m", sphere.middle_m);
  if (status.ok()) status = check_radius(place, sphere.radius_m);
  return status.ok() ? check_surface(place, sphere) : status;
}

Status check_obstacle(const Capsule& capsule, uint32_t index) noexcept {
  const Place place = {"capsule", index};
  Status status = check_finite(place, "ends_m", capsule.ends_m[0]);
  if (status.ok()) status = check_finite(place, "ends_m", capsule.ends_m[1]);
  if (status.ok()) status = check_radius(place, capsule.radius_m);
  return status.ok() ? check_surface(place, capsule) : status;
}

Status check_obstacle(const ContactPoint& point, uint32_t index) noexcept {
  const Place place = {"contact point", index};
  if (!(point.along >= -1 && point.along <= 1)) {
    return refuse(place, "along", static_cast<double>(point.along), "give -1 to 1");
  }
  if (!std::isfinite(point.gap_m)) return refuse(place, "gap_m", point.gap_m, "give a finite number");
  Status status = check_normal(place, point.normal);
  if (status.ok()) status = check_finite(place, "velocity_m_s", point.velocity_m_s);
  if (status.ok()) status = check_friction(place, point.friction);
  return status.ok() ? check_restitution(place, point.restitution) : status;
}

}  // namespace sinew::rods

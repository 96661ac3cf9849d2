// test_check_obstacle.cpp  Each obstacle that cannot be collided with is refused by name and place.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>

#include "rods/contacts/obstacle.hpp"

using namespace sinew;

namespace {

template <class Obstacle>
struct Bad {
  const char* expected;
  std::function<void(Obstacle&)> spoil;
};

const float kNan = std::nanf("");

const Bad<rods::Plane> kPlanes[] = {
    {"plane 3: point_m is nan", [](auto& p) { p.point_m[1] = std::nan(""); }},
    {"plane 3: the length of normal is 2", [](auto& p) { p.normal[1] = 2; }},
    {"plane 3: the length of normal is 0", [](auto& p) { p.normal[1] = 0; }},
    {"plane 3: the length of normal is nan", [](auto& p) { p.normal[0] = kNan; }},
    {"plane 3: friction is -1", [](auto& p) { p.friction = -1; }},
    {"plane 3: friction is inf", [](auto& p) { p.friction = HUGE_VALF; }},
    {"plane 3: restitution is -0.1; give 0 to 1", [](auto& p) { p.restitution = -0.1f; }},
    {"plane 3: restitution is nan", [](auto& p) { p.restitution = kNan; }},
    {"plane 3: linear_m_s is inf", [](auto& p) { p.motion.linear_m_s[2] = HUGE_VALF; }},
    {"plane 3: angular_rad_s is nan", [](auto& p) { p.motion.angular_rad_s[0] = kNan; }},
};
const Bad<rods::Sphere> kSpheres[] = {
    {"sphere 3: middle_m is inf", [](auto& s) { s.middle_m[2] = HUGE_VAL; }},
    {"sphere 3: radius_m is 0", [](auto& s) { s.radius_m = 0; }},
    {"sphere 3: radius_m is -1", [](auto& s) { s.radius_m = -1; }},
    {"sphere 3: radius_m is nan", [](auto& s) { s.radius_m = kNan; }},
    {"sphere 3: friction is nan", [](auto& s) { s.friction = kNan; }},
    {"sphere 3: restitution is 2", [](auto& s) { s.restitution = 2; }},
    {"sphere 3: linear_m_s is nan", [](auto& s) { s.motion.linear_m_s[0] = kNan; }},
};
const Bad<rods::Capsule> kCapsules[] = {
    {"capsule 3: ends_m is nan", [](auto& c) { c.ends_m[0][1] = std::nan(""); }},
    {"capsule 3: ends_m is inf", [](auto& c) { c.ends_m[1][2] = HUGE_VAL; }},
    {"capsule 3: radius_m is 0", [](auto& c) { c.radius_m = 0; }},
    {"capsule 3: friction is -0.5", [](auto& c) { c.friction = -0.5f; }},
    {"capsule 3: restitution is 1.5", [](auto& c) { c.restitution = 1.5f; }},
    {"capsule 3: angular_rad_s is inf", [](auto& c) { c.motion.angular_rad_s[1] = HUGE_VALF; }},
};
const Bad<rods::ContactPoint> kPoints[] = {
    {"contact point 3: along is 1.5", [](auto& p) { p.along = 1.5f; }},
    {"contact point 3: along is nan", [](auto& p) { p.along = kNan; }},
    {"contact point 3: gap_m is nan", [](auto& p) { p.gap_m = std::nan(""); }},
    {"contact point 3: the length of normal is 3", [](auto& p) { p.normal[1] = 3; }},
    {"contact point 3: velocity_m_s is inf", [](auto& p) { p.velocity_m_s[0] = HUGE_VALF; }},
    {"contact point 3: restitution is nan", [](auto& p) { p.restitution = kNan; }},
    {"contact point 3: friction is -2", [](auto& p) { p.friction = -2; }},
};

template <class Obstacle>
void check_refused(const Obstacle& good, std::span<const Bad<Obstacle>> bad) {
  CHECK(rods::check_obstacle(good, 3).ok());
  for (const Bad<Obstacle>& b : bad) {
    Obstacle spoilt = good;
    b.spoil(spoilt);
    const Status status = rods::check_obstacle(spoilt, 3);
    INFO(b.expected << " | " << status.message);
    CHECK_FALSE(status.ok());
    CHECK(std::string(status.message).find(b.expected) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("obstacles_that_cannot_be_collided_with_are_refused_by_name_and_place") {
  check_refused<rods::Plane>({}, kPlanes);
  check_refused<rods::Sphere>({.radius_m = 1}, kSpheres);
  check_refused<rods::Capsule>({.radius_m = 1}, kCapsules);
  check_refused<rods::ContactPoint>({}, kPoints);
}

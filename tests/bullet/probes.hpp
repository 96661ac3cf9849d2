// probes.hpp  Probes, what finds their contacts, and how these are looked at.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "sinew/bullet.hpp"
#include "tests/scenes/bullet_world.hpp"

namespace sinew::test {

inline constexpr float kTick_s = 1.0f / 60;

struct Point {
  double x, y, z;
};

inline ContactProbe moving_probe(const Point& a, const Point& b, const Point& way, float radius_m) {
  ContactProbe p{{{a.x, a.y, a.z}, {b.x, b.y, b.z}},
                 {{a.x + way.x, a.y + way.y, a.z + way.z}, {b.x + way.x, b.y + way.y, b.z + way.z}},
                 radius_m};
  return p;
}
inline ContactProbe probe(const Point& a, const Point& b, float radius_m) {
  return moving_probe(a, b, {0, 0, 0}, radius_m);
}
inline ContactProbe ball(const Point& at, float radius_m) { return probe(at, at, radius_m); }

inline BulletContacts contacts_of(BulletWorld& world, BulletDef def = {}) {
  BulletContacts made;
  def.world = &world.world;
  REQUIRE(BulletContacts::create(def, &made).ok());
  return made;
}

inline std::vector<ContactHit> find(BulletContacts& contacts, const std::vector<ContactProbe>& probes,
                                    float dt_s = kTick_s) {
  std::vector<ContactHit> hits(64 + 8 * probes.size());
  const uint32_t count = contacts.find(probes, dt_s, hits);
  REQUIRE(count <= hits.size());
  hits.resize(count);
  return hits;
}
inline std::vector<ContactHit> find(BulletWorld& world, const ContactProbe& one) {
  BulletContacts contacts = contacts_of(world);
  return find(contacts, {one});
}

inline double along_normal(const ContactHit& hit, const Point& d) {
  return static_cast<double>(hit.normal[0]) * d.x + static_cast<double>(hit.normal[1]) * d.y +
         static_cast<double>(hit.normal[2]) * d.z;
}

// The deepest, which there has to be.
inline ContactHit deepest(const std::vector<ContactHit>& hits) {
  REQUIRE_FALSE(hits.empty());
  return *std::min_element(hits.begin(), hits.end(),
                           [](const ContactHit& a, const ContactHit& b) { return a.gap_m < b.gap_m; });
}

inline void check_hit(const ContactHit& hit, double gap_m, const Point& normal, double exact_m = 1e-6) {
  CHECK(hit.gap_m == Approx(gap_m).margin(exact_m));
  CHECK(along_normal(hit, normal) == Approx(1).margin(1e-4));
}

}  // namespace sinew::test

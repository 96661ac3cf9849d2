// test_fast_bodies.cpp  What passes by or through within a tick.
#include <random>

#include "tests/bullet/probes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

constexpr double kDt = 1.0 / 60;

// What is left of the gap at the end of a tick in which the probe moves by `way`.
double gap_then(const ContactHit& hit, const Point& way) {
  const Point v{static_cast<double>(hit.velocity_m_s[0]), static_cast<double>(hit.velocity_m_s[1]),
                static_cast<double>(hit.velocity_m_s[2])};
  return hit.gap_m + along_normal(hit, {way.x - kDt * v.x, way.y - kDt * v.y, way.z - kDt * v.z});
}

}  // namespace

TEST_CASE("a_faster_body_than_was_said_is_counted_and_named") {
  BulletWorld world;
  btRigidBody* body = world.body(world.shape<btSphereShape>(0.1f), {0, 0, 0}, 1);
  body->setLinearVelocity({50, 0, 0});
  BulletContacts contacts = contacts_of(world, {.fastest_body_m_s = 10});
  find(contacts, {ball({-0.1, 0, 0}, 0.05f)});
  CHECK(contacts.report().counts[static_cast<uint32_t>(BulletProblem::kTooFast)] == 1);
  CHECK_THAT(contacts.problem(0).message, Catch::Contains("fastest_body_m_s"));
}

// Thin: a centimetre. Its way in a tick is 83 cm.
TEST_CASE("no_thin_body_at_fifty_metres_a_second_passes_a_segment_unseen") {
  BulletWorld world;
  auto* capsule = world.shape<btCapsuleShape>(0.005f, 0.3f);
  auto* hull = world.shape<btConvexHullShape>();
  for (const float x : {-0.005f, 0.005f})
    for (const float y : {-0.15f, 0.15f})
      for (const float z : {-0.005f, 0.005f}) hull->addPoint({x, y, z});
  hull->setMargin(0.001f);
  auto* box = world.shape<btBoxShape>(btVector3(0.005f, 0.15f, 0.005f));
  auto* plate = world.shape<btBvhTriangleMeshShape>(
      world.mesh({{0, -0.15f, -0.15f}, {0, 0.15f, -0.15f}, {0, 0, 0.2f}}), true);
  plate->setMargin(0.001f);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(-1, 1);
  BulletContacts contacts = contacts_of(world);
  int missed = 0;
  for (btCollisionShape* shape :
       {static_cast<btCollisionShape*>(capsule), static_cast<btCollisionShape*>(hull),
        static_cast<btCollisionShape*>(box), static_cast<btCollisionShape*>(plate)}) {
    btRigidBody* body = world.kinematic(shape);
    for (int i = 0; i < 1000; ++i) {
      // Both go through a point near the origin at some moment of the tick.
      const float when = 0.5f + 0.45f * any(random);
      const btVector3 v(50, 10 * any(random), 10 * any(random));
      const btVector3 meet(0, 0.05f * any(random), 0);
      body->setLinearVelocity(v);
      body->setWorldTransform(btTransform(btQuaternion::getIdentity(), v * (kTick_s * (1 - when)) + meet));
      world.world.updateSingleAabb(body);
      const Point a{0.02 * static_cast<double>(any(random)), meet.y(),
                    -0.05 + 0.02 * static_cast<double>(any(random))};
      const ContactProbe p = probe(a, {-a.x, a.y, 0.1 + a.z}, 0.002f);
      bool stopped = false;
      for (const ContactHit& hit : find(contacts, {p})) stopped |= gap_then(hit, {0, 0, 0}) < 0;
      missed += !stopped;
    }
    world.world.removeRigidBody(body);
  }
  CHECK(missed == 0);
}

TEST_CASE("a_fast_probe_stops_at_a_thin_wall") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(0.001f, 2, 2)));
  const std::vector<ContactHit> hits =
      find(world, moving_probe({-0.3, 0, 0}, {-0.3, 0.1, 0}, {1, 0, 0}, 0.01f));
  REQUIRE_FALSE(hits.empty());
  for (const ContactHit& hit : hits) {
    check_hit(hit, 0.289, {-1, 0, 0}, 1e-5);
    CHECK(gap_then(hit, {1, 0, 0}) < 0);
  }
}

TEST_CASE("a_spinning_blade_meets_what_waits_on_its_arc") {
  BulletWorld world;
  btRigidBody* blade = world.kinematic(world.shape<btBoxShape>(btVector3(1, 0.005f, 0.05f)));
  blade->setAngularVelocity({0, 0, 48});  // 0.8 rad a tick
  // It ends along x; half a tick before it stood at -0.4 rad. A chord would pass 8 cm inside of the tip.
  const double angle = -0.4;
  const std::vector<ContactHit> hits =
      find(world, ball({0.98 * std::cos(angle), 0.98 * std::sin(angle), 0}, 0.005f));
  const ContactHit hit = deepest(hits);
  CHECK(gap_then(hit, {0, 0, 0}) < -0.2);
  CHECK(along_normal(hit, {-std::sin(angle), std::cos(angle), 0}) > 0.99);
}

// A body that flies past has a plane too, which must not sweep up what it leaves alone.
TEST_CASE("what_flies_past_catches_nothing") {
  BulletWorld world;
  btRigidBody* body = world.kinematic(world.shape<btSphereShape>(0.05f));
  body->setLinearVelocity({50, 0, 0});
  std::mt19937 random(6);
  std::uniform_real_distribution<float> any(-1, 1);
  BulletContacts contacts = contacts_of(world);
  int caught = 0, asked = 0;
  for (int i = 0; i < 2000; ++i) {
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), {0.4f + 0.4f * any(random), 0, 0}));
    world.world.updateSingleAabb(body);
    const double side = 0.0525 + 0.0505 + 0.1 * std::fabs(static_cast<double>(any(random)));
    const double slant = 0.5 * static_cast<double>(any(random));
    const ContactProbe p =
        probe({-0.05 * slant, side, -0.05}, {0.05 * slant, side + 0.02 * slant * slant, 0.05}, 0.05f);
    for (const ContactHit& hit : find(contacts, {p})) ++asked, caught += gap_then(hit, {0, 0, 0}) < 0;
  }
  CHECK(asked > 1000);
  CHECK(caught == 0);
}

TEST_CASE("both_ends_of_a_falling_segment_meet_the_floor") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(5, 0.5f, 5)));
  const Point way{0, -0.3, 0};
  const std::vector<ContactHit> hits = find(world, moving_probe({-0.2, 0.62, 0}, {0.2, 0.67, 0}, way, 0.01f));
  bool ends[2] = {};
  for (const ContactHit& hit : hits) {
    CHECK(gap_then(hit, way) < 0);
    CHECK(hit.velocity_m_s[1] == 0);
    ends[0] |= hit.along == -1, ends[1] |= hit.along == 1;
  }
  CHECK((ends[0] && ends[1]));
}

// test_impulses.cpp  What rods do to bodies.
#include <thread>

#include "tests/bullet/probes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

ContactHit hit_of(BulletContacts& contacts, const Point& at) {
  return deepest(find(contacts, {ball(at, 0.1f)}));
}

}  // namespace

TEST_CASE("bad_pushes_are_dropped_and_counted") {
  BulletWorld world;
  btRigidBody* body = world.body(world.shape<btSphereShape>(1.0f), {0, 0, 0}, 2);
  BulletContacts contacts = contacts_of(world, {.push_capacity = 1});
  const ContactHit hit = hit_of(contacts, {0, 1.1, 0});
  contacts.push(hit, {0, 1, 0}, {0, std::nanf(""), 0});
  contacts.push(hit, {0, std::nan(""), 0}, {0, 1, 0});
  contacts.push(hit, {0, 1, 0}, {2e6f, 0, 0});
  CHECK(contacts.report().pushes_dropped == 3);
  CHECK(contacts.apply_impulses() == 0);
  CHECK(body->getLinearVelocity().length() == 0);
  // Without room, of bodies that do not move, and before create: nothing.
  BulletContacts none = contacts_of(world);
  none.push(hit_of(none, {0, 1.1, 0}), {0, 1, 0}, {0, 1, 0});
  CHECK(none.apply_impulses() == 0);
  BulletContacts().push(hit, {0, 1, 0}, {0, 1, 0});
  world.body(world.shape<btSphereShape>(1.0f), {5, 0, 0});
  contacts.push(hit_of(contacts, {5, 1.1, 0}), {5, 1, 0}, {0, -1, 0});
  CHECK(contacts.apply_impulses() == 0);
}

TEST_CASE("pushes_add_up_to_a_body_s_linear_and_angular_momentum") {
  BulletWorld world;
  btRigidBody* body = world.body(world.shape<btBoxShape>(btVector3(1, 1, 1)), {3, 0, 0}, 6);
  body->setActivationState(ISLAND_SLEEPING);
  BulletContacts contacts = contacts_of(world, {.origin_m = {100, 0, 0}, .push_capacity = 4});
  const ContactHit hit = hit_of(contacts, {103, 1.1, 0});
  contacts.push(hit, {104, 1, 0}, {0, -3, 0});
  contacts.push(hit, {103, 1, 0}, {1.5f, 0, 0});
  CHECK(contacts.apply_impulses() == 1);
  CHECK(body->isActive());
  // Inertia of the cube: 6 * (4 + 4) / 12 = 4. Moments: 1 * -3 and -1 * 1.5.
  CHECK(body->getLinearVelocity().x() == Approx(0.25));
  CHECK(body->getLinearVelocity().y() == Approx(-0.5));
  CHECK(body->getAngularVelocity().z() == Approx(-4.5 / 4));
  CHECK(contacts.apply_impulses() == 0);
}

TEST_CASE("a_body_that_was_removed_meanwhile_gets_nothing_and_others_get_theirs") {
  BulletWorld world;
  auto* shape = world.shape<btSphereShape>(1.0f);
  btRigidBody* first = world.body(shape, {0, 0, 0}, 1);
  btRigidBody* second = world.body(shape, {5, 0, 0}, 1);
  BulletContacts contacts = contacts_of(world, {.push_capacity = 4});
  const ContactHit a = hit_of(contacts, {0, 1.1, 0}), b = hit_of(contacts, {5, 1.1, 0});
  contacts.push(a, {0, 1, 0}, {0, -1, 0});
  contacts.push(b, {5, 1, 0}, {0, -1, 0});
  world.world.removeRigidBody(first);  // the second takes its place in the list
  world.body(shape, {0, 0, 0}, 1);
  CHECK(contacts.apply_impulses() == 1);
  CHECK(contacts.report().pushes_dropped == 1);
  CHECK(second->getLinearVelocity().y() == -1);
}

TEST_CASE("sums_of_pushes_do_not_depend_on_threads") {
  BulletWorld world;
  auto* shape = world.shape<btSphereShape>(1.0f);
  std::vector<btRigidBody*> bodies;
  for (int i = 0; i < 8; ++i) bodies.push_back(world.body(shape, {5.0f * static_cast<float>(i), 0, 0}, 1));
  BulletContacts contacts = contacts_of(world, {.push_capacity = 8});
  const auto work = [&](int begin, int end) {
    std::vector<ContactHit> hits(8);
    for (int i = begin; i < end; ++i) {
      const ContactProbe p = ball({5.0 * (i % 8), 1.1, 0}, 0.1f);
      if (contacts.find({&p, 1}, kTick_s, hits) != 1) continue;
      contacts.push(hits[0], {5.0 * (i % 8), 1, 0}, {0.1f, -0.3f / static_cast<float>(1 + i), 0});
    }
  };
  work(0, 400);
  CHECK(contacts.apply_impulses() == 8);
  std::vector<float> alone;
  for (btRigidBody* body : bodies) {
    alone.push_back(body->getLinearVelocity().y());
    body->setLinearVelocity({0, 0, 0});
  }
  std::vector<std::thread> threads;
  for (int t = 3; t >= 0; --t) threads.emplace_back(work, 100 * t, 100 * t + 100);
  for (std::thread& t : threads) t.join();
  CHECK(contacts.apply_impulses() == 8);
  for (size_t i = 0; i < bodies.size(); ++i) CHECK(bodies[i]->getLinearVelocity().y() == alone[i]);
}

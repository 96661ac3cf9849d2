// test_problems.cpp  Bodies that nothing can be done with.
#include <BulletCollision/CollisionShapes/btSdfCollisionShape.h>

#include "tests/bullet/probes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

uint64_t count(const BulletContacts& contacts, BulletProblem problem) {
  return contacts.report().counts[static_cast<uint32_t>(problem)];
}

// A body with the wrong shape or pose at the origin, and a good one beside it.
void check_left_out(BulletWorld& world, BulletProblem problem, const char* words) {
  world.body(world.shape<btSphereShape>(1.0f), {2, 0, 0});
  BulletContacts contacts = contacts_of(world);
  for (int i = 0; i < 3; ++i) {
    const std::vector<ContactHit> hits = find(contacts, {probe({1.1, 0.85, 0}, {1.8, 1.05, 0}, 0.1f)});
    CHECK_FALSE(hits.empty());
    for (const ContactHit& hit : hits) CHECK(std::isfinite(hit.gap_m));
  }
  CHECK(count(contacts, problem) == 3);
  CHECK(contacts.report().named == 1);
  INFO(contacts.problem(0).message);
  CHECK_THAT(contacts.problem(0).message, Catch::Contains("body 0") && Catch::Contains(words));
  CHECK(contacts.problem(1).ok());
  CHECK(contacts.problem(1000).ok());
}

}  // namespace

TEST_CASE("a_body_without_volume_is_left_out") {
  BulletWorld world;
  auto* box = world.shape<btBoxShape>(btVector3(1, 1, 1));
  box->setLocalScaling({1, 0, 1});
  world.body(box, btVector3(1, 0.9f, 0));
  check_left_out(world, BulletProblem::kZeroVolume, "no volume");
}

TEST_CASE("a_hull_of_no_points_is_left_out") {
  BulletWorld world;
  auto* hull = world.shape<btConvexHullShape>();
  hull->setMargin(0);
  world.body(hull, btVector3(1.2f, 0.9f, 0));
  check_left_out(world, BulletProblem::kZeroVolume, "no volume");
}

TEST_CASE("a_body_that_is_nowhere_is_left_out") {
  for (int what = 0; what < 3; ++what) {
    BulletWorld world;
    btRigidBody* body = world.body(world.shape<btBoxShape>(btVector3(1, 1, 1)), {1, 0, 0}, 1);
    btTransform nowhere = body->getWorldTransform();
    nowhere.getOrigin().setY(std::nanf(""));
    if (what == 0) body->setWorldTransform(nowhere);
    if (what == 1) body->setLinearVelocity({std::nanf(""), 0, 0});
    if (what == 2) body->setAngularVelocity({0, HUGE_VALF, 0});
    check_left_out(world, BulletProblem::kNotFinite, "not finite");
  }
}

TEST_CASE("a_flat_hull_without_margin_is_left_out_whichever_way_it_lies") {
  for (const float turn_rad : {0.0f, 0.7f}) {
    BulletWorld world;
    auto* hull = world.shape<btConvexHullShape>();
    for (int i = 0; i < 4; ++i) {
      const btVector3 corner(i % 2 ? 1.0f : -1.0f, 0, i / 2 ? 1.0f : -1.0f);
      hull->addPoint(quatRotate(btQuaternion(btVector3(1, 2, 0.5f).normalized(), turn_rad), corner));
    }
    hull->setMargin(0);
    world.body(hull, btVector3(1, 0.8f, 0));
    check_left_out(world, BulletProblem::kZeroVolume, "no volume");
  }
}

TEST_CASE("a_body_that_is_added_nowhere_is_counted_at_each_call_and_named_once") {
  for (const float mass_kg : {0.0f, 1.0f}) {
    BulletWorld world;
    world.body(world.shape<btBoxShape>(btVector3(1, 1, 1)), {std::nanf(""), 0, 0}, mass_kg);
    BulletContacts contacts = contacts_of(world);
    for (int i = 0; i < 3; ++i) CHECK(find(contacts, {ball({0, 0, 0}, 0.1f)}).empty());
    CHECK(count(contacts, BulletProblem::kNotFinite) == 3);
    CHECK(contacts.report().named == 1);
    CHECK_THAT(contacts.problem(0).message, Catch::Contains("body 0") && Catch::Contains("not finite"));
  }
}

TEST_CASE("a_body_that_is_added_nowhere_among_many_is_named_in_some_calls") {
  BulletWorld world;
  for (int i = 0; i < 100; ++i)
    world.body(world.shape<btSphereShape>(1.0f), {5.0f * static_cast<float>(i), 9, 0});
  world.body(world.shape<btSphereShape>(1.0f), {0, std::nanf(""), 0});
  BulletContacts contacts = contacts_of(world);
  for (int i = 0; i < 7; ++i) find(contacts, {ball({0, 0, 0}, 0.1f)});
  CHECK(count(contacts, BulletProblem::kNotFinite) == 1);
  CHECK(contacts.report().named == 1);
}

TEST_CASE("a_body_that_is_added_nowhere_hides_no_other_once_it_is_found") {
  for (const int bodies : {1, 2, 5, 40}) {
    BulletWorld world;
    const auto add = [&](float x, float y) {
      return world.body(world.shape<btSphereShape>(1.0f), {x, y, 0});
    };
    for (int i = 0; i < bodies; ++i) {
      if (i == bodies / 2) add(0, std::nanf(""));
      add(5.0f * static_cast<float>(i), 0);
    }
    BulletContacts contacts = contacts_of(world);
    for (int i = 0; i < 3; ++i) find(contacts, {ball({0, 1.05, 0}, 0.1f)});
    for (int i = 0; i < 6; ++i) {
      for (int b = 0; b < bodies; ++b) CHECK(find(contacts, {ball({5.0 * b, 1.05, 0}, 0.1f)}).size() == 1);
    }
    CHECK(contacts.report().named == 1);
  }
}

TEST_CASE("a_body_that_is_added_nowhere_is_found_and_named_though_its_filter_disagrees_or_it_is_a_trigger") {
  for (const bool trigger : {false, true}) {
    BulletWorld world;
    world.body(world.shape<btSphereShape>(1.0f));
    btRigidBody* lost = world.body(world.shape<btSphereShape>(1.0f), {0, 30, 0});
    world.world.removeRigidBody(lost);
    lost->setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, std::nanf(""), 0}));
    if (trigger)
      lost->setCollisionFlags(lost->getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    world.world.addRigidBody(lost, 64, trigger ? -1 : 64);
    world.body(world.shape<btSphereShape>(1.0f), {5, 0, 0});
    BulletContacts contacts = contacts_of(world, {.mask = trigger ? -1 : ~64});
    for (int i = 0; i < 3; ++i) {
      for (const double x : {0.0, 5.0}) CHECK(find(contacts, {ball({x, 1.05, 0}, 0.1f)}).size() == 1);
    }
    CHECK(count(contacts, BulletProblem::kNotFinite) == 6);
    CHECK(contacts.report().named == 1);
  }
}

TEST_CASE("a_body_that_was_nowhere_is_touched_once_it_is_mended_in_its_place") {
  BulletWorld world;
  btRigidBody* lost = world.body(world.shape<btSphereShape>(1.0f), {0, std::nanf(""), 0});
  world.body(world.shape<btSphereShape>(1.0f), {5, 0, 0});
  BulletContacts contacts = contacts_of(world);
  find(contacts, {ball({0, 1.05, 0}, 0.1f)});
  const uint64_t counted = count(contacts, BulletProblem::kNotFinite);
  REQUIRE(counted == 1);
  lost->setWorldTransform(btTransform::getIdentity());
  world.world.updateSingleAabb(lost);
  for (const double x : {0.0, 5.0}) CHECK(find(contacts, {ball({x, 1.05, 0}, 0.1f)}).size() == 1);
  CHECK(count(contacts, BulletProblem::kNotFinite) == counted);
}

TEST_CASE("a_body_that_is_nowhere_is_forgotten_once_it_is_taken_out_and_not_when_another_is") {
  BulletWorld world;
  btRigidBody* other = nullptr;
  for (int i = 0; i < 200; ++i)
    other = world.body(world.shape<btSphereShape>(1.0f), {5.0f * static_cast<float>(i), 9, 0});
  btRigidBody* lost = world.body(world.shape<btSphereShape>(1.0f), {0, std::nanf(""), 0});
  BulletContacts contacts = contacts_of(world);
  for (int i = 0; i < 14; ++i) find(contacts, {ball({0, 0, 0}, 0.1f)});
  const auto told = [&] { return count(contacts, BulletProblem::kNotFinite); };
  uint64_t before = told();
  REQUIRE(before > 0);
  world.world.removeRigidBody(other);  // the last one of the list takes its place
  find(contacts, {ball({0, 0, 0}, 0.1f)});
  CHECK(told() == before + 1);
  world.world.removeRigidBody(lost);
  before = told();
  for (int i = 0; i < 14; ++i) find(contacts, {ball({0, 0, 0}, 0.1f)});
  CHECK(told() == before);
}

TEST_CASE("while_bodies_are_asked_one_by_one_those_far_away_are_not_too_many") {
  BulletWorld world;
  world.body(world.shape<btSphereShape>(1.0f), {0, std::nanf(""), 0});
  for (int i = 0; i < 64; ++i) world.body(world.shape<btSphereShape>(1.0f));
  for (int i = 0; i < 20; ++i) world.body(world.shape<btSphereShape>(1.0f), {1000, 0, 0});
  BulletContacts contacts = contacts_of(world);
  CHECK_FALSE(find(contacts, {ball({0, 1.05, 0}, 0.1f)}).empty());
  CHECK(count(contacts, BulletProblem::kTooMany) == 0);
  CHECK(contacts.report().named == 1);
}

TEST_CASE("a_compound_s_child_that_is_nowhere_is_left_out_and_the_others_are_touched") {
  for (const bool tree : {false, true}) {
    for (const int lost : {0, 1, 2}) {
      BulletWorld world;
      auto* compound = world.shape<btCompoundShape>(tree);
      for (int i = 0; i < 3; ++i) {
        const btVector3 at(0, i == lost ? std::nanf("") : 0.0f, 0);
        compound->addChildShape(btTransform(btQuaternion::getIdentity(), at),
                                world.shape<btSphereShape>(0.5f));
      }
      world.body(compound);
      BulletContacts contacts = contacts_of(world);
      CHECK(find(contacts, {ball({0, 0.59, 0}, 0.1f)}).size() == 2);
      CHECK(count(contacts, BulletProblem::kNotFinite) == 1);
      CHECK_THAT(contacts.problem(0).message, Catch::Contains("body 0") && Catch::Contains("not finite"));
    }
  }
}

// Wherever it is of a thousand, and in a compound of a compound: its tree is not asked, in no call.
TEST_CASE("a_compound_of_many_children_is_touched_in_each_call_though_one_is_nowhere") {
  for (const bool nested : {false, true}) {
    for (const int lost : {3, 70, 254, 1000}) {
      BulletWorld world;
      auto* compound = world.shape<btCompoundShape>(true);
      for (int i = 0; i < 1001; ++i) {
        const btVector3 at(2.0f * static_cast<float>(i), i == lost ? std::nanf("") : 0.0f, 0);
        compound->addChildShape(btTransform(btQuaternion::getIdentity(), at),
                                world.shape<btSphereShape>(0.5f));
      }
      auto* outer = world.shape<btCompoundShape>(true);
      outer->addChildShape(btTransform::getIdentity(), compound);
      world.body(nested ? outer : compound);
      BulletContacts contacts = contacts_of(world);
      for (int i = 0; i < 9; ++i) CHECK(find(contacts, {ball({0, 0.59, 0}, 0.1f)}).size() == 1);
      CHECK(count(contacts, BulletProblem::kNotFinite) == 9);
      CHECK(contacts.report().named == 1);
    }
  }
}

TEST_CASE("friction_and_restitution_that_are_not_finite_count_as_none_and_are_named") {
  for (const bool friction : {false, true}) {
    BulletWorld world;
    btRigidBody* body = world.body(world.shape<btSphereShape>(1.0f));
    if (friction)
      body->setFriction(std::nanf(""));
    else
      body->setRestitution(HUGE_VALF);
    BulletContacts contacts = contacts_of(world, {.restitution = 1});
    for (int i = 0; i < 2; ++i) {
      const ContactHit hit = deepest(find(contacts, {ball({0, 1.05, 0}, 0.1f)}));
      CHECK((friction ? hit.friction : hit.restitution) == 0);
    }
    CHECK(count(contacts, BulletProblem::kNotFinite) == 2);
    CHECK(contacts.report().named == 1);
    CHECK_THAT(contacts.problem(0).message, Catch::Contains("friction or restitution"));
  }
}

TEST_CASE("a_shape_that_is_not_known_is_left_out") {
  BulletWorld world;
  struct Custom : btSphereShape {
    Custom() : btSphereShape(1) { m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE; }
  };
  world.body(world.shape<Custom>(), btVector3(1, 0, 0));
  check_left_out(world, BulletProblem::kUnsupportedShape, "not known");
}

TEST_CASE("a_shape_that_is_meant_to_be_empty_is_no_problem") {
  BulletWorld world;
  world.body(world.shape<btEmptyShape>());
  BulletContacts contacts = contacts_of(world);
  CHECK(find(contacts, {ball({0, 0, 0}, 0.1f)}).empty());
  CHECK(contacts.report().named == 0);
}

TEST_CASE("more_bodies_at_a_place_than_are_looked_at_are_counted") {
  BulletWorld world;
  for (int i = 0; i < 70; ++i)
    world.body(world.shape<btSphereShape>(1.0f), {0.001f * static_cast<float>(i), 0, 0});
  BulletContacts contacts = contacts_of(world);
  CHECK_FALSE(find(contacts, {ball({0, 1.1, 0}, 0.1f)}).empty());
  CHECK(count(contacts, BulletProblem::kTooMany) == 6);
}

// test_bullet_contacts.cpp  Probes at each kind of body, against what geometry says.
#include <limits>

#include "tests/bullet/probes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

btTransform moved(float x, float y, float z) { return btTransform(btQuaternion::getIdentity(), {x, y, z}); }

btTransform turned(const btVector3& axis, float angle, const btVector3& at = {0, 0, 0}) {
  return btTransform(btQuaternion(axis.normalized(), angle), at);
}

void check_refused(const BulletDef& def, const char* words) {
  BulletContacts out;
  const Status status = BulletContacts::create(def, &out);
  INFO(status.message);
  CHECK_FALSE(status.ok());
  CHECK_THAT(status.message, Catch::Contains(words));
  CHECK(out.find({}, kTick_s, {}) == 0);
}

}  // namespace

TEST_CASE("bullet_contacts_refuse_every_bad_definition_and_probe") {
  BulletWorld world;
  world.body(world.shape<btSphereShape>(1.0f));
  const BulletDef good{.world = &world.world};
  check_refused({}, "world");
  for (const float bad : {-1.0f, kNan, std::numeric_limits<float>::infinity()}) {
    BulletDef def = good;
    def.friction = bad;
    check_refused(def, "friction");
    def = good, def.restitution = bad;
    check_refused(def, "restitution");
    def = good, def.fastest_body_m_s = bad;
    check_refused(def, "fastest_body_m_s");
  }
  BulletDef def = good;
  def.push_capacity = 70000;
  check_refused(def, "push_capacity");
  def = good, def.origin_m[1] = HUGE_VAL;
  check_refused(def, "origin_m");
  BulletContacts contacts = contacts_of(world);
  CHECK_FALSE(contacts.set_origin({0, std::nan(""), 0}).ok());

  const ContactProbe touching = ball({0, 1, 0}, 0.1f);
  CHECK(find(contacts, {touching}).size() == 1);
  for (const float dt : {0.0f, -1.0f, kNan, std::numeric_limits<float>::infinity()})
    CHECK(find(contacts, {touching}, dt).empty());
  for (const float radius : {-0.1f, kNan}) CHECK(find(contacts, {ball({0, 1, 0}, radius)}).empty());
  ContactProbe broken = touching;
  broken.end_m[1][2] = std::nan("");
  const std::vector<ContactHit> hits = find(contacts, {broken, touching});
  CHECK(hits.size() == 1);
  CHECK(hits[0].probe == 1);
  CHECK(BulletContacts().find({&touching, 1}, kTick_s, {}) == 0);
}

TEST_CASE("a_probe_at_a_sphere_has_its_gap_and_normal") {
  BulletWorld world;
  world.body(world.shape<btSphereShape>(0.5f), moved(1, 2, 3));
  check_hit(deepest(find(world, ball({1, 2.62, 3}, 0.1f))), 0.02, {0, 1, 0});
  check_hit(deepest(find(world, ball({1, 2.3, 3}, 0.1f))), -0.3, {0, 1, 0});
  // A capsule across: nearest in its middle.
  const ContactHit across = deepest(find(world, probe({0, 2, 3.61}, {2, 2, 3.61}, 0.1f)));
  check_hit(across, 0.01, {0, 0, 1}, 2e-4);  // the search stops at a thousandth of the radius
  CHECK(across.along == Approx(0).margin(0.05));
  CHECK(find(world, ball({1, 2.64, 3}, 0.1f)).empty());  // further than a quarter of the radius
}

TEST_CASE("a_probe_at_a_box_has_its_gap_at_face_edge_and_corner") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(1, 0.5f, 2)), turned({0, 1, 0}, 0.5f, {3, 0, 0}));
  const double c = std::cos(0.5), s = std::sin(0.5);
  const auto at = [&](double x, double y, double z) { return Point{3 + c * x + s * z, y, -s * x + c * z}; };
  check_hit(deepest(find(world, ball(at(0.3, 0.61, 0.4), 0.1f))), 0.01, {0, 1, 0});
  check_hit(deepest(find(world, ball(at(1.06, 0.58, 0), 0.1f))), 0.0, {0.6 * c, 0.8, -0.6 * s}, 2e-6);
  const double d = 0.1 / std::sqrt(3.0), k = 1 / std::sqrt(3.0);
  check_hit(deepest(find(world, ball(at(1 + d, 0.5 + d, 2 + d), 0.1f))), 0, {k * (c + s), k, k * (c - s)},
            2e-6);
  check_hit(deepest(find(world, ball(at(0.3, 0.4, 0.4), 0.1f))), -0.2, {0, 1, 0});
}

TEST_CASE("a_segment_that_lies_flat_touches_at_both_ends_of_where_it_lies") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(1, 0.5f, 1)));
  std::vector<ContactHit> hits = find(world, probe({-0.4, 0.52, 0}, {0.4, 0.52, 0}, 0.02f));
  REQUIRE(hits.size() == 2);
  for (const ContactHit& hit : hits) {
    check_hit(hit, 0, {0, 1, 0});
    CHECK(std::fabs(hit.along) == 1);
  }
  CHECK(hits[0].along != hits[1].along);
  CHECK(hits[0].name != hits[1].name);
  // Half of it stands out over the edge, which holds it to a thousandth of its length.
  hits = find(world, probe({0.5, 0.52, 0}, {1.5, 0.52, 0}, 0.02f));
  REQUIRE(hits.size() == 2);
  const auto [inner, outer] = std::minmax(hits[0].along, hits[1].along);
  CHECK(inner == -1);
  CHECK(outer == Approx(0).margin(0.02));
  // Raised at one end by as much as its reach, that end is told too.
  hits = find(world, probe({-0.4, 0.52, 0}, {0.4, 0.5203, 0}, 0.02f));
  bool end = false;
  for (const ContactHit& hit : hits) end |= hit.along == 1 && std::fabs(hit.gap_m - 0.0003) < 1e-6;
  CHECK(end);
}

TEST_CASE("a_probe_at_a_capsule_a_cylinder_and_a_cone_has_its_gap") {
  BulletWorld world;
  world.body(world.shape<btCapsuleShapeX>(0.2f, 1.0f));
  world.body(world.shape<btCylinderShapeZ>(btVector3(0.3f, 0.3f, 1)), moved(0, 5, 0));
  auto* cone = world.shape<btConeShape>(0.5f, 1.0f);
  cone->setMargin(0.01f);
  world.body(cone, moved(0, -5, 0));
  check_hit(deepest(find(world, ball({0.3, 0.31, 0}, 0.1f))), 0.01, {0, 1, 0});
  check_hit(deepest(find(world, ball({0.8, 0, 0}, 0.1f))), 0, {1, 0, 0}, 1e-6);
  check_hit(deepest(find(world, ball({0, 5.39, 0.7}, 0.1f))), -0.01, {0, 1, 0});
  check_hit(deepest(find(world, ball({0, 5.1, 1.11}, 0.1f))), 0.01, {0, 0, 1});
  check_hit(deepest(find(world, ball({0.24, 5.18, 0.5}, 0.1f))), -0.1, {0.8, 0.6, 0}, 1e-5);
  // The rim is sharp: 0.06 and 0.08 away from it.
  check_hit(deepest(find(world, ball({0, 5.36, 1.08}, 0.1f))), 0, {0, 0.6, 0.8}, 1e-5);
  // A cone's side, of slope 1 to 2, by GJK, which knows it to a tenth of a millimetre.
  const double n = std::sqrt(1.25);
  check_hit(deepest(find(world, ball({0.25 + 0.12 / n, -5 + 0.06 / n, 0}, 0.1f))), 0.01, {1 / n, 0.5 / n, 0},
            2e-4);
}

TEST_CASE("a_probe_at_a_convex_hull_has_its_gap_with_the_collision_margin") {
  BulletWorld world;
  auto* hull = world.shape<btConvexHullShape>();
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      for (const float z : {-1.0f, 1.0f}) hull->addPoint({x, y, z});
  hull->setMargin(0.01f);
  world.body(hull, turned({0, 0, 1}, 0.3f));
  const double c = std::cos(0.3), s = std::sin(0.3), h = 1.01;
  const auto at = [&](double x, double y, double z) { return Point{c * x - s * y, s * x + c * y, z}; };
  const Point up{-s, c, 0};
  // Bullet's GJK and EPA work to a tenth of a millimetre.
  check_hit(deepest(find(world, ball(at(0.2, h + 0.11, 0.3), 0.1f))), 0.01, up, 1e-4);
  check_hit(deepest(find(world, ball(at(0.2, h + 0.05, 0.3), 0.1f))), -0.05, up, 1e-4);
  check_hit(deepest(find(world, ball(at(0.2, h - 0.2, 0.3), 0.1f))), -0.3, up, 1e-3);
  const Point a = at(-0.5, h + 0.1, 0), b = at(0.5, h + 0.1, 0);
  const std::vector<ContactHit> flat = find(world, probe(a, b, 0.1f));
  REQUIRE(flat.size() == 2);
  for (const ContactHit& hit : flat) check_hit(hit, 0, up, 1e-4);
}

TEST_CASE("a_probe_at_a_plane_has_its_gap") {
  BulletWorld world;
  world.body(world.shape<btStaticPlaneShape>(btVector3(0, 0.6f, 0.8f), 2.0f));
  const ContactHit hit = deepest(find(world, ball({100, 0.6 * 2.1, 0.8 * 2.1}, 0.1f)));
  check_hit(hit, 0, {0, 0.6, 0.8}, 1e-6);
  CHECK(find(world, probe({0, 1.2, 1.6}, {5, 1.2, 1.6}, 0.1f)).size() == 2);
}

TEST_CASE("a_compound_s_children_are_found_where_they_hang") {
  BulletWorld world;
  for (const bool tree : {true, false}) {
    auto* compound = world.shape<btCompoundShape>(tree);
    auto* inner = world.shape<btCompoundShape>(tree);
    inner->addChildShape(turned({1, 0, 0}, 1.5707963f, {0, 0, 1}),
                         world.shape<btCylinderShape>(btVector3(0.2f, 1, 0.2f)));
    for (int i = 0; i < 6; ++i)
      compound->addChildShape(moved(static_cast<float>(i), 0, 0), world.shape<btSphereShape>(0.1f));
    compound->addChildShape(moved(0, 3, 0), inner);
    btRigidBody* body = world.body(compound, turned({0, 0, 1}, 1.5707963f));
    check_hit(deepest(find(world, ball({0, 4, 0.17}, 0.1f))), -0.03, {0, 0, 1}, 1e-5);
    // Child space (0, 3 + 0.3, 1) is world (-3.3, 0, 1).
    check_hit(deepest(find(world, ball({-3.3, 0, 1}, 0.1f))), 0, {-1, 0, 0}, 1e-5);
    CHECK(find(world, ball({0, 2.5, 0}, 0.1f)).empty());
    world.world.removeRigidBody(body);
  }
}

TEST_CASE("contacts_move_as_their_bodies_do") {
  BulletWorld world;
  btRigidBody* box = world.body(world.shape<btBoxShape>(btVector3(1, 0.5f, 1)), moved(0, 0, 0), 1);
  box->setLinearVelocity({0.3f, 0.6f, 0});
  box->setAngularVelocity({0, 0, 0.5f});
  ContactHit hit = deepest(find(world, ball({0.8, 0.6, 0}, 0.1f)));
  // Velocity of (0.8, 0.5, 0) is (0.3 - 0.5 * 0.5, 0.6 + 0.5 * 0.8, 0); a turn of 8 mrad bends it by 1 %.
  CHECK(static_cast<double>(hit.velocity_m_s[0]) == Approx(0.05).margin(0.01));
  CHECK(static_cast<double>(hit.velocity_m_s[1]) == Approx(1).margin(0.01));
  // At the tick's end the surface touches, so at its start it was a tick's way lower.
  CHECK(hit.gap_m == Approx(1.0 / 60).epsilon(0.02));
  box->setActivationState(ISLAND_SLEEPING);
  hit = deepest(find(world, ball({0.8, 0.6, 0}, 0.1f)));
  CHECK(hit.velocity_m_s[1] == 0);

  btRigidBody* kinematic = world.kinematic(world.shape<btSphereShape>(1.0f), moved(0, 10, 0));
  for (int i = 1; i < 4; ++i) {
    kinematic->setWorldTransform(moved(0, 10 + 0.01f * static_cast<float>(i), 0));
    world.world.stepSimulation(kTick_s, 0, kTick_s);
  }
  hit = deepest(find(world, ball({0, 11.1, 0}, 0.1f)));
  CHECK(static_cast<double>(hit.velocity_m_s[1]) == Approx(0.6).epsilon(0.01));
  CHECK(hit.gap_m == Approx(-0.02).margin(1e-3));
}

TEST_CASE("friction_and_restitution_are_the_pair_s_products") {
  BulletWorld world;
  btRigidBody* body = world.body(world.shape<btSphereShape>(1.0f));
  body->setFriction(0.8f);
  body->setRestitution(0.6f);
  BulletContacts contacts = contacts_of(world, {.friction = 0.5f, .restitution = 0.5f});
  const ContactHit hit = deepest(find(contacts, {ball({0, 1.1, 0}, 0.1f)}));
  CHECK(hit.friction == Approx(0.4));
  CHECK(hit.restitution == Approx(0.3));
}

TEST_CASE("filters_of_both_sides_must_agree") {
  BulletWorld world;
  world.body(world.shape<btSphereShape>(1.0f), moved(0, 0, 0), 0, 2, 4);
  const ContactProbe touching = ball({0, 1.1, 0}, 0.1f);
  const auto found = [&](const BulletDef& def) {
    BulletContacts contacts = contacts_of(world, def);
    return find(contacts, {touching}).size();
  };
  CHECK(found({.group = 4, .mask = 2}) == 1);
  CHECK(found({.group = 1, .mask = 2}) == 0);
  CHECK(found({.group = 4, .mask = 1}) == 0);
  BulletDef asks{.group = 4, .mask = 2};
  asks.accepts = [](void* context, uint32_t owner, const btCollisionObject&) {
    ++*static_cast<int*>(context);
    return owner == 7;
  };
  int asked = 0;
  asks.context = &asked;
  CHECK(found(asks) == 0);
  CHECK(asked == 1);
  ContactProbe own = touching;
  own.owner = 7;
  BulletContacts contacts = contacts_of(world, asks);
  CHECK(find(contacts, {own}).size() == 1);
}

TEST_CASE("triggers_are_not_touched") {
  BulletWorld world;
  btRigidBody* body = world.body(world.shape<btSphereShape>(1.0f));
  body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  CHECK(find(world, ball({0, 1.1, 0}, 0.1f)).empty());
}

TEST_CASE("far_from_the_origin_contacts_are_as_exact_as_near_it") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(1, 0.5f, 1)));
  // At 1e7 m float knows a metre.
  BulletContacts contacts = contacts_of(world, {.origin_m = {1e7, -2e7, 3e7}});
  check_hit(deepest(find(contacts, {ball({1e7, -2e7 + 0.605, 3e7}, 0.1f)})), 0.005, {0, 1, 0}, 1e-7);
  REQUIRE(contacts.set_origin({0, 5, 0}).ok());
  check_hit(deepest(find(contacts, {ball({0, 5.605, 0}, 0.1f)})), 0.005, {0, 1, 0});
}

TEST_CASE("bodies_may_come_move_and_go_between_two_ticks") {
  BulletWorld world;
  BulletContacts contacts = contacts_of(world);
  const ContactProbe touching = ball({0, 1.1, 0}, 0.1f);
  CHECK(find(contacts, {touching}).empty());
  auto* shape = world.shape<btSphereShape>(1.0f);
  auto body = std::make_unique<btRigidBody>(0.0f, nullptr, shape);
  world.world.addRigidBody(body.get());
  const ContactHit first = deepest(find(contacts, {touching}));
  CHECK(deepest(find(contacts, {touching})).name == first.name);
  body->setWorldTransform(moved(5, 0, 0));
  world.world.updateSingleAabb(body.get());
  CHECK(find(contacts, {touching}).empty());
  CHECK(find(contacts, {ball({5, 1.1, 0}, 0.1f)}).size() == 1);
  world.world.removeRigidBody(body.get());
  body.reset();
  CHECK(find(contacts, {ball({5, 1.1, 0}, 0.1f)}).empty());
  world.body(shape, moved(0, 0, 0));
  CHECK(deepest(find(contacts, {touching})).name != first.name);
}

TEST_CASE("of_more_contacts_than_there_is_room_for_the_deepest_are_kept") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(50, 0.5f, 1)));
  std::vector<ContactProbe> probes;
  for (int i = 0; i < 40; ++i) probes.push_back(ball({i - 20.0, 0.6 - 0.001 * (i * 7 % 40), 0}, 0.1f));
  BulletContacts contacts = contacts_of(world);
  ContactHit hits[5];
  CHECK(contacts.find(probes, kTick_s, hits) == 40);
  double sum = 0;
  for (const ContactHit& hit : hits) sum += hit.gap_m;
  CHECK(sum == Approx(-0.001 * (39 + 38 + 37 + 36 + 35)));
}

TEST_CASE("a_joint_of_two_segments_is_one_contact") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(5, 0.5f, 1)));
  std::vector<ContactProbe> chain;
  for (int i = 0; i < 4; ++i) chain.push_back(probe({0.3 * i, 0.6, 0}, {0.3 * (i + 1), 0.6, 0}, 0.1f));
  BulletContacts contacts = contacts_of(world);
  CHECK(find(contacts, chain).size() == 5);
  chain[2].owner = 1;  // of another strand
  CHECK(find(contacts, chain).size() == 7);
}

TEST_CASE("points_at_one_place_are_each_told_their_contacts") {
  BulletWorld world;
  world.body(world.shape<btBoxShape>(btVector3(5, 0.5f, 1)));
  BulletContacts contacts = contacts_of(world);
  for (const float radius_m : {0.0f, 0.1f}) {
    const ContactProbe point = ball({0.2, 0.45, 0}, radius_m);
    const size_t alone = find(contacts, {point}).size();
    CHECK(alone > 0);
    CHECK(find(contacts, {point, point, point}).size() == 3 * alone);
  }
}

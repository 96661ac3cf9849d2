// test_short_memory.cpp  In an executable of its own: it replaces the allocator.
#include "tests/bullet/probes.hpp"
#include "tests/pack/short_memory.hpp"

using namespace sinew;
using namespace sinew::test;

TEST_CASE("without_memory_bullet_contacts_are_not_made") {
  BulletWorld world;
  world.body(world.shape<btSphereShape>(1.0f), {0, 0, 0});
  for (const bool and_all_after : {false, true}) {
    BulletContacts contacts;
    const Refusals refusals = refuse_each(
        [&] { return BulletContacts::create({.world = &world.world, .push_capacity = 64}, &contacts); },
        [] { return true; }, {and_all_after});
    INFO(refusals.wrong);
    REQUIRE(refusals.wrong.empty());
    CHECK(refusals.count >= 2);
    CHECK_FALSE(find(contacts, {ball({1.01, 0, 0}, 0.05f)}).empty());
  }
}

// test_allocations.cpp  Nothing in find and push allocates, by Bullet's allocator or by operator new. In an
// executable of its own: it replaces both.
#include <LinearMath/btAlignedAllocator.h>

#include "tests/bullet/probes.hpp"
#include "tests/pack/count_allocations.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

size_t bullet_allocations = 0;

void* count_allocation(size_t bytes) {
  ++bullet_allocations;
  return std::malloc(bytes);
}

void fill(BulletWorld& world) {
  auto* hull = world.shape<btConvexHullShape>();
  for (int i = 0; i < 20; ++i) {
    const float x = static_cast<float>(i);
    hull->addPoint({0.5f * std::sin(x), 0.5f * std::cos(1.7f * x), 0.5f * std::sin(2.3f * x)});
  }
  auto* compound = world.shape<btCompoundShape>(true);
  for (int i = 0; i < 30; ++i)
    compound->addChildShape(btTransform(btQuaternion::getIdentity(), {0, 0.1f * static_cast<float>(i), 0}),
                            hull);
  std::vector<btVector3> corners;
  for (int i = 0; i < 600; ++i)
    corners.push_back(
        {static_cast<float>(i % 7), 0.2f * static_cast<float>(i % 3), static_cast<float>(i % 11)});
  btCollisionShape* shapes[] = {world.shape<btBoxShape>(btVector3(0.5f, 0.5f, 0.5f)),
                                world.shape<btSphereShape>(0.5f),
                                hull,
                                compound,
                                world.shape<btConeShape>(0.5f, 1.0f),
                                world.shape<btBvhTriangleMeshShape>(world.mesh(corners), true)};
  for (int i = 0; i < 300; ++i) {
    const float x = static_cast<float>(i % 17), z = static_cast<float>(i / 17);
    world.body(shapes[i % 6], {x, 0.3f * static_cast<float>(i % 5), z}, i % 6 == 5 ? 0.0f : 1.0f)
        ->setLinearVelocity({1, 0, -1});
  }
}

}  // namespace

// And while bodies are asked one by one, for one is nowhere.
TEST_CASE("finding_contacts_allocates_nothing") {
  btAlignedAllocSetCustom(count_allocation, std::free);
  for (const bool one_is_nowhere : {false, true}) {
    BulletWorld world;
    if (one_is_nowhere) world.body(world.shape<btSphereShape>(1.0f), {0, std::nanf(""), 0});
    fill(world);
    CHECK(bullet_allocations > 0);
    BulletContacts contacts = contacts_of(world, {.push_capacity = 64});
    std::vector<ContactProbe> probes;
    for (int i = 0; i < 400; ++i) {
      const double x = 0.04 * i, z = 17 * std::fabs(std::sin(0.1 * i));
      probes.push_back(moving_probe({x, 0.4, z}, {x + 0.1, 0.5, z}, {0, -0.2, 0.1}, 0.05f));
    }
    std::vector<ContactHit> hits(4000);
    size_t found = 0;
    const auto tick = [&] {
      const uint32_t count = contacts.find(probes, kTick_s, hits);
      found += count;
      for (uint32_t i = 0; i < std::min<size_t>(count, hits.size()); ++i)
        contacts.push(hits[i], {0, 0, 0}, {0, 0.01f, 0});
      contacts.apply_impulses();
    };
    const size_t before = allocation_count(), bullet_before = bullet_allocations;
    for (int i = 0; i < 20; ++i) tick();
    CHECK(allocation_count() == before);
    CHECK(bullet_allocations == bullet_before);
    CHECK(found > 1000);
  }
  btAlignedAllocSetCustom(nullptr, nullptr);
}

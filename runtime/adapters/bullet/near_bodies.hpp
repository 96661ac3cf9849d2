// near_bodies.hpp  The bodies that a few probes may meet in a tick, and how they move in it.
#pragma once
#include <span>

#include "adapters/bullet/moving_place.hpp"
#include "adapters/bullet/problems.hpp"
#include "adapters/bullet/touch.hpp"

namespace sinew::bullet {

struct Box {
  Vector low, high;

  void widen(const Vector& point) noexcept;
  void grow(double by_m) noexcept;
  bool overlaps(const Box& other) const noexcept;
};
// Of a path, its radius and `reach_m` around.
Box box_of(const Path& path, double reach_m) noexcept;

struct Body {
  const btCollisionObject* object;
  Motion motion;
  Box box;          // from the tick's start to its end
  uint64_t handle;  // 0: nothing moves it
  uint32_t name;
  float friction, restitution;
  bool lost_child;  // of a compound, that is nowhere: its tree is not to be trusted
};

inline constexpr uint32_t kMostBodies = 64;

struct BodyCollector;

struct NearBodies {
  const BulletDef& def;
  double dt_s;
  Problems& problems;
  bool is_tree_spoilt = false;  // find_lost() found one: every body is asked, one by one

  // Those whose way meets the box. Returns how many.
  uint32_t find(const Box& box, std::span<Body, kMostBodies> out) const noexcept;
  // The place in the world's list of one that was added nowhere, of `count` from `begin` on, around; kNone.
  // Its box has no order, and the broadphase's tree may hide others with it, whatever its filter.
  uint32_t find_lost(uint32_t begin, uint32_t count) const noexcept;
  bool is_lost(uint32_t index) const noexcept;
  static constexpr uint32_t kLookedAt = 16, kAll = ~0u, kNone = ~0u;  // bodies, a call

 private:
  friend struct BodyCollector;
  bool agrees(const btCollisionObject& object) const noexcept;
  bool describe(const btCollisionObject& object, Body* out) const noexcept;
  void look_at_children(Body* body) const noexcept;
  void visit_all(const Box& wide, BodyCollector& collector) const noexcept;
  static constexpr int kChildrenLookedAt = 1024;  // of a body; a few microseconds
};

}  // namespace sinew::bullet

// near_bodies.cpp  see near_bodies.hpp.
#include "adapters/bullet/near_bodies.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "adapters/bullet/impulses.hpp"

namespace sinew::bullet {
namespace {

// Infinite shapes have boxes of 1e18 m and more.
constexpr double kVast_m = 1e12;

Vector vector_of(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

struct Velocity {
  Vector linear_m_s = {}, angular_rad_s = {};
};

Velocity velocity_of(const btCollisionObject& object) {
  if (object.isStaticObject() || object.getActivationState() == ISLAND_SLEEPING ||
      object.getActivationState() == DISABLE_SIMULATION) {
    return {};
  }
  if (const btRigidBody* body = btRigidBody::upcast(&object)) {
    return {vector_of(body->getLinearVelocity()), vector_of(body->getAngularVelocity())};
  }
  return {vector_of(object.getInterpolationLinearVelocity()),
          vector_of(object.getInterpolationAngularVelocity())};
}

// Bullet's box, which is of one moment and a little wider, over the body's way.
Box swept_box(const btBroadphaseProxy& proxy, const Motion& motion) {
  Box box = {vector_of(proxy.m_aabbMin), vector_of(proxy.m_aabbMax)};
  const double arm = rods::length(rods::difference(box.high, box.low));
  box.grow(rods::length(motion.move_m) +
           std::min(rods::length(motion.spin_rad), 2.0) * std::min(arm, kVast_m));
  return box;
}

bool finite(const Box& box) { return rods::finite(box.low) && rods::finite(box.high); }

Box box_of(const btBroadphaseProxy& proxy) {
  return {vector_of(proxy.m_aabbMin), vector_of(proxy.m_aabbMax)};
}

// Of `left` children at most, those of children included.
bool has_lost_child(const btCollisionShape& shape, int* left) {
  if (!shape.isCompound()) return false;
  const auto& compound = static_cast<const btCompoundShape&>(shape);
  for (int i = 0; i < compound.getNumChildShapes() && *left > 0; ++i) {
    --*left;
    if (!finite(place_of(compound.getChildTransform(i)))) return true;
    if (has_lost_child(*compound.getChildShape(i), left)) return true;
  }
  return false;
}

float finite_or_0(float x) { return std::isfinite(x) ? x : 0; }

uint32_t mixed(uint32_t id) { return (id + 1) * 0x9e3779b9u; }

}  // namespace

void Box::widen(const Vector& point) noexcept {
  for (size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], point[k]), high[k] = std::max(high[k], point[k]);
}

void Box::grow(double by_m) noexcept {
  for (size_t k = 0; k < 3; ++k) low[k] -= by_m, high[k] += by_m;
}

bool Box::overlaps(const Box& other) const noexcept {
  for (size_t k = 0; k < 3; ++k) {
    if (!(low[k] <= other.high[k] && other.low[k] <= high[k])) return false;
  }
  return true;
}

Box box_of(const Path& path, double reach_m) noexcept {
  Box box = {path.start[0], path.start[0]};
  for (const Vector& point : {path.start[1], path.end[0], path.end[1]}) box.widen(point);
  box.grow(path.radius_m + reach_m);
  return box;
}

bool NearBodies::agrees(const btCollisionObject& object) const noexcept {
  const btBroadphaseProxy* proxy = object.getBroadphaseHandle();
  return object.hasContactResponse() && (proxy->m_collisionFilterGroup & def.mask) != 0 &&
         (def.group & proxy->m_collisionFilterMask) != 0;
}

bool NearBodies::describe(const btCollisionObject& object, Body* out) const noexcept {
  const Velocity v = velocity_of(object);
  const Place now = place_of(object.getWorldTransform());
  const int shape = object.getCollisionShape()->getShapeType();
  if (!finite(now) || !rods::finite(v.linear_m_s) || !rods::finite(v.angular_rad_s)) {
    problems.note(BulletProblem::kNotFinite, object, shape);
    return false;
  }
  if (rods::length(v.linear_m_s) > 1.001 * static_cast<double>(def.fastest_body_m_s)) {
    problems.note(BulletProblem::kTooFast, object, shape);
  }
  const btBroadphaseProxy& proxy = *object.getBroadphaseHandle();
  const Vector move = rods::scaled(dt_s, v.linear_m_s), spin = rods::scaled(dt_s, v.angular_rad_s);
  out->motion = Motion::ending_at(now, move, spin);
  out->object = &object;
  out->box = swept_box(proxy, out->motion);
  if (!finite(out->box)) {
    problems.note(BulletProblem::kNotFinite, object, shape);
    return false;
  }
  const bool dynamic = def.push_capacity > 0 && !object.isStaticOrKinematicObject();
  out->handle = dynamic ? handle_of(object.getWorldArrayIndex(), proxy.m_uniqueId) : 0;
  out->name = mixed(static_cast<uint32_t>(proxy.m_uniqueId));
  const float friction = def.friction * object.getFriction(),
              bounce = def.restitution * object.getRestitution();
  out->friction = finite_or_0(friction);
  out->restitution = std::clamp(finite_or_0(bounce), 0.0f, 1.0f);
  if (!std::isfinite(friction) || !std::isfinite(bounce)) {
    problems.note(BulletProblem::kNotFinite, object, shape);
  }
  return true;
}

void NearBodies::look_at_children(Body* body) const noexcept {
  const btCollisionShape& shape = *body->object->getCollisionShape();
  int left = kChildrenLookedAt;
  body->lost_child = has_lost_child(shape, &left);
  if (body->lost_child) problems.note(BulletProblem::kNotFinite, *body->object, shape.getShapeType());
}

struct BodyCollector final : btBroadphaseAabbCallback {
  const NearBodies& near;
  const Box& box;
  std::span<Body, kMostBodies> out;
  uint32_t count = 0;

  BodyCollector(const NearBodies& of, const Box& in, std::span<Body, kMostBodies> to)
      : near(of), box(in), out(to) {}

  bool process(const btBroadphaseProxy* proxy) override {
    const auto& object = *static_cast<const btCollisionObject*>(proxy->m_clientObject);
    if (!near.agrees(object)) return true;
    if (count == kMostBodies) {
      near.problems.note(BulletProblem::kTooMany, object, object.getCollisionShape()->getShapeType());
    } else if (near.describe(object, &out[count]) && out[count].box.overlaps(box)) {
      near.look_at_children(&out[count++]);
    }
    return true;
  }
};

// One that is lost is told whatever its filter, for it spoils the tree for all.
void NearBodies::visit_all(const Box& wide, BodyCollector& collector) const noexcept {
  const btCollisionObjectArray& all = def.world->getCollisionObjectArray();
  for (int i = 0; i < all.size(); ++i) {
    const btBroadphaseProxy* proxy = all[i]->getBroadphaseHandle();
    if (!proxy) continue;
    const Box own = box_of(*proxy);
    if (!finite(own))
      problems.note(BulletProblem::kNotFinite, *all[i], all[i]->getCollisionShape()->getShapeType());
    else if (own.overlaps(wide))
      collector.process(proxy);
  }
}

uint32_t NearBodies::find(const Box& box, std::span<Body, kMostBodies> out) const noexcept {
  Box wide = box;
  wide.grow(static_cast<double>(def.fastest_body_m_s) * dt_s);
  btVector3 low, high;
  for (size_t k = 0; k < 3; ++k) {
    low[static_cast<int>(k)] = static_cast<btScalar>(wide.low[k]);
    high[static_cast<int>(k)] = static_cast<btScalar>(wide.high[k]);
  }
  BodyCollector collector(*this, box, out);
  if (is_tree_spoilt)
    visit_all(wide, collector);
  else
    def.world->getBroadphase()->aabbTest(low, high, collector);
  return collector.count;
}

bool NearBodies::is_lost(uint32_t index) const noexcept {
  const btCollisionObjectArray& all = def.world->getCollisionObjectArray();
  if (index >= static_cast<uint32_t>(all.size())) return false;
  const btCollisionObject& object = *all[static_cast<int>(index)];
  const btBroadphaseProxy* proxy = object.getBroadphaseHandle();
  return proxy && !finite(box_of(*proxy));
}

uint32_t NearBodies::find_lost(uint32_t begin, uint32_t count) const noexcept {
  const auto size = static_cast<uint32_t>(def.world->getNumCollisionObjects());
  for (uint32_t i = 0; i < std::min(count, size); ++i) {
    const uint32_t index = (begin + i) % size;
    if (is_lost(index)) return index;
  }
  return kNone;
}

}  // namespace sinew::bullet

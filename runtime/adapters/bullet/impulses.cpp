// impulses.cpp  see impulses.hpp.
#include "adapters/bullet/impulses.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <bit>

namespace sinew::bullet {
namespace {

constexpr double kUnits = 1099511627776.0;  // 2^40 a newton second: a hair's impulse has six digits
constexpr double kMost = 1e6;               // N s or N m s

bool small_enough(const Vector& v) {
  return std::fabs(v[0]) <= kMost && std::fabs(v[1]) <= kMost && std::fabs(v[2]) <= kMost;
}

btVector3 bullet_vector(const Vector& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}

bool is(const btCollisionObject& object, uint64_t handle) {
  const btBroadphaseProxy* proxy = object.getBroadphaseHandle();
  return proxy && static_cast<uint32_t>(proxy->m_uniqueId) == static_cast<uint32_t>(handle >> 32);
}

// Other bodies' removal moves a body in the list.
btCollisionObject* object_of(uint64_t handle, btCollisionWorld* world) {
  btCollisionObjectArray& all = world->getCollisionObjectArray();
  const int index = static_cast<int>(static_cast<uint32_t>(handle)) - 1;
  if (index < all.size() && is(*all[index], handle)) return all[index];
  for (int i = 0; i < all.size(); ++i) {
    if (is(*all[i], handle)) return all[i];
  }
  return nullptr;
}

}  // namespace

uint64_t handle_of(int world_index, int proxy_id) noexcept {
  return uint64_t{static_cast<uint32_t>(proxy_id)} << 32 | (static_cast<uint32_t>(world_index) + 1);
}

bool Impulses::reserve(uint32_t bodies) noexcept {
  if (bodies == 0) return true;
  size_ = std::bit_ceil(2 * bodies);
  memory_ = core::AlignedBlock(size_ * sizeof(Slot));
  if (!memory_.data()) return false;
  slots_ = reinterpret_cast<Slot*>(memory_.data());
  for (uint32_t i = 0; i < size_; ++i) new (slots_ + i) Slot();
  return true;
}

Impulses::Slot* Impulses::find(uint64_t handle) noexcept {
  uint32_t at = static_cast<uint32_t>((handle * 0x9e3779b97f4a7c15u) >> 40);
  for (uint32_t tries = 0; tries < size_; ++tries, ++at) {
    Slot& slot = slots_[at & (size_ - 1)];
    uint64_t there = slot.handle.load(std::memory_order_relaxed);
    if (there == handle) return &slot;
    if (there != 0) continue;
    if (slot.handle.compare_exchange_strong(there, handle, std::memory_order_relaxed)) {
      used_.fetch_add(1, std::memory_order_relaxed);
      return &slot;
    }
    if (there == handle) return &slot;
  }
  return nullptr;
}

void Impulses::add(uint64_t handle, const Vector& point_m, const Vector& impulse_n_s) noexcept {
  if (size_ == 0 || handle == 0) return;
  const Vector moment = rods::cross(point_m, impulse_n_s);
  Slot* slot = small_enough(impulse_n_s) && small_enough(moment) ? find(handle) : nullptr;
  if (!slot) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  for (size_t k = 0; k < 3; ++k) {
    slot->sums[k].fetch_add(std::llround(kUnits * impulse_n_s[k]), std::memory_order_relaxed);
    slot->sums[3 + k].fetch_add(std::llround(kUnits * moment[k]), std::memory_order_relaxed);
  }
}

bool Impulses::apply(const Slot& slot, btCollisionWorld* world) noexcept {
  btCollisionObject* object = object_of(slot.handle.load(std::memory_order_relaxed), world);
  if (!object) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  btRigidBody* body = btRigidBody::upcast(object);
  if (!body || body->isStaticOrKinematicObject()) return false;
  Vector impulse, moment;
  for (size_t k = 0; k < 3; ++k) {
    impulse[k] = static_cast<double>(slot.sums[k].load(std::memory_order_relaxed)) / kUnits;
    moment[k] = static_cast<double>(slot.sums[3 + k].load(std::memory_order_relaxed)) / kUnits;
  }
  const btVector3& centre = body->getCenterOfMassPosition();
  const Vector arm = {centre.x(), centre.y(), centre.z()};
  body->applyCentralImpulse(bullet_vector(impulse));
  body->applyTorqueImpulse(bullet_vector(rods::difference(moment, rods::cross(arm, impulse))));
  body->activate();
  return true;
}

uint32_t Impulses::apply(btCollisionWorld* world) noexcept {
  uint32_t count = 0;
  if (used_.exchange(0, std::memory_order_relaxed) == 0) return 0;
  for (uint32_t i = 0; i < size_; ++i) {
    Slot& slot = slots_[i];
    if (slot.handle.load(std::memory_order_relaxed) == 0) continue;
    count += apply(slot, world);
    for (auto& sum : slot.sums) sum.store(0, std::memory_order_relaxed);
    slot.handle.store(0, std::memory_order_relaxed);
  }
  return count;
}

}  // namespace sinew::bullet

// impulses.hpp  Sums of what pushed each body, in whole numbers, so that their order does not matter.
#pragma once
#include <atomic>
#include <cstdint>

#include "core/aligned_block.hpp"
#include "rods/vector.hpp"

class btCollisionWorld;

namespace sinew::bullet {

using rods::Vector;

// Of a body as long as it is in the world; never 0.
uint64_t handle_of(int world_index, int proxy_id) noexcept;

class Impulses {
 public:
  // For so many bodies; false: no memory.
  bool reserve(uint32_t bodies) noexcept;
  // At a point in Bullet's world. From several threads at a time.
  void add(uint64_t handle, const Vector& point_m, const Vector& impulse_n_s) noexcept;
  // To dynamic bodies that are still there; begins anew. Returns how many.
  uint32_t apply(btCollisionWorld* world) noexcept;
  uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Slot {
    std::atomic<uint64_t> handle;  // 0: free
    std::atomic<int64_t> sums[6];  // of impulses, and of their moments about Bullet's origin
  };
  Slot* find(uint64_t handle) noexcept;
  bool apply(const Slot& slot, btCollisionWorld* world) noexcept;

  core::AlignedBlock memory_;
  Slot* slots_ = nullptr;
  uint32_t size_ = 0;
  std::atomic<uint32_t> used_ = 0;
  std::atomic<uint64_t> dropped_ = 0;
};

}  // namespace sinew::bullet

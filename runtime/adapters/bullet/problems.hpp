// problems.hpp  What was left out and why: counted each time, named once.
#pragma once
#include <atomic>

#include "sinew/bullet.hpp"

namespace sinew::bullet {

// From several threads at a time; nothing waits.
class Problems {
 public:
  void note(BulletProblem problem, const btCollisionObject& body, int shape_type) noexcept;
  BulletReport report() const noexcept;
  Status line(uint32_t index) const noexcept;

 private:
  static constexpr uint32_t kNamed = 32;
  std::atomic<uint64_t> counts_[static_cast<uint32_t>(BulletProblem::kCount)] = {};
  std::atomic<uint64_t> named_[kNamed] = {};  // packed; 0: free
};

}  // namespace sinew::bullet

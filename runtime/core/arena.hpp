// arena.hpp  Lays arrays out in one allocation: the same code first measures, then places.
#pragma once
#include <cstddef>

namespace sinew::core {

// With a null base take() returns null and only counts, so a layout function is run twice: once for the size,
// once for the pointers, and the two cannot disagree.
class Arena {
 public:
  static constexpr size_t kAlignment = 64;  // a cache line, and the widest vector

  explicit Arena(std::byte* base = nullptr) noexcept : base_(base) {}

  template <class T>
  T* take(size_t count) noexcept {
    static_assert(alignof(T) <= kAlignment);
    const size_t start = used_;
    used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    return base_ ? reinterpret_cast<T*>(base_ + start) : nullptr;
  }
  size_t used_bytes() const noexcept { return used_; }  // a multiple of kAlignment

 private:
  std::byte* base_;
  size_t used_ = 0;
};

}  // namespace sinew::core

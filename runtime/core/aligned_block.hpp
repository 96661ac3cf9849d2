// aligned_block.hpp  One owned, cache-line aligned, zeroed block of memory.
#pragma once
#include <cstddef>
#include <cstring>
#include <new>
#include <utility>

#include "core/arena.hpp"

namespace sinew::core {

class AlignedBlock {
 public:
  AlignedBlock() noexcept = default;
  // Null data when the system has no memory left.
  explicit AlignedBlock(size_t bytes) noexcept
      : data_(static_cast<std::byte*>(
            ::operator new (bytes ? bytes : 1, std::align_val_t{Arena::kAlignment}, std::nothrow))) {
    if (data_) std::memset(data_, 0, bytes);
  }
  ~AlignedBlock() { ::operator delete (data_, std::align_val_t{Arena::kAlignment}); }
  AlignedBlock(AlignedBlock&& other) noexcept : data_(std::exchange(other.data_, nullptr)) {}
  AlignedBlock& operator=(AlignedBlock&& other) noexcept {
    std::swap(data_, other.data_);
    return *this;
  }
  std::byte* data() const noexcept { return data_; }

 private:
  std::byte* data_ = nullptr;
};

}  // namespace sinew::core

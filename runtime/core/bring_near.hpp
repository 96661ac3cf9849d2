// bring_near.hpp  Memory that is wanted soon comes into the cache while other work is done.
#pragma once
#include <cstddef>

namespace sinew::core {

inline void bring_near(const void* from, size_t bytes) noexcept {
  constexpr size_t kLine = 64;
  for (size_t i = 0; i < bytes; i += kLine) __builtin_prefetch(static_cast<const char*>(from) + i);
}

}  // namespace sinew::core

// clock.cpp  Monotonic time, the caller's or the steady clock's.
#include "core/clock.hpp"

#include <chrono>

namespace sinew::core {

uint64_t now_ns(const ClockHook& clock) noexcept {
  if (clock.now_ns) return clock.now_ns(clock.context);
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(since).count());
}

}  // namespace sinew::core

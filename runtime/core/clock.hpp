// clock.hpp  Monotonic time, the caller's or the steady clock's.
#pragma once
#include <cstdint>

#include "sinew/types.hpp"

namespace sinew::core {

uint64_t now_ns(const ClockHook& clock) noexcept;

inline float microseconds(uint64_t ns) noexcept { return static_cast<float>(static_cast<double>(ns) * 1e-3); }

}  // namespace sinew::core

// floating_point.hpp  The floating-point mode that the library computes in, whatever the host's is: rounding
// to the nearest, nothing traps, denormals are zero (decaying gates otherwise slow down several times).
#pragma once
#include <cstdint>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace sinew::core {

// For a scope on this thread. The thread's own control word comes back whole at its end.
class FloatingPointScope {
 public:
  FloatingPointScope() noexcept : saved_(read()) { write(kMode); }
  ~FloatingPointScope() { write(saved_); }
  FloatingPointScope(const FloatingPointScope&) = delete;
  FloatingPointScope& operator=(const FloatingPointScope&) = delete;

 private:
#if defined(__SSE2__)
  static constexpr uint64_t kMode = 0x1f80 | 0x8040;  // all exceptions masked; FTZ and DAZ
  static uint64_t read() noexcept { return _mm_getcsr(); }
  static void write(uint64_t mode) noexcept { _mm_setcsr(static_cast<uint32_t>(mode)); }
#elif defined(__aarch64__)
  static constexpr uint64_t kMode = uint64_t{1} << 24;  // FPCR.FZ alone
  static uint64_t read() noexcept {
    uint64_t mode;
    asm volatile("mrs %0, fpcr" : "=r"(mode));
    return mode;
  }
  static void write(uint64_t mode) noexcept { asm volatile("msr fpcr, %0" : : "r"(mode)); }
#else
  static constexpr uint64_t kMode = 0;
  static uint64_t read() noexcept { return 0; }
  static void write(uint64_t) noexcept {}
#endif
  uint64_t saved_;
};

}  // namespace sinew::core

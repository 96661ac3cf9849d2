// test_flush_denormals.cpp  Denormals are zero inside the scope, and the thread's own mode comes back.
#include <catch2/catch.hpp>

#include "core/flush_denormals.hpp"

namespace {

float half_of(float value) {
  const volatile float at_run_time = value;
  return at_run_time * 0.5f;
}

}  // namespace

#if defined(__SSE2__) || defined(__aarch64__)
TEST_CASE("denormals_are_flushed_in_the_scope_only") {
  constexpr float kSmallestNormal = 1.17549435e-38f;
  CHECK(half_of(kSmallestNormal) > 0);
  {
    const sinew::core::FlushDenormals flush;
    CHECK(half_of(kSmallestNormal) == 0);
  }
  CHECK(half_of(kSmallestNormal) > 0);
}
#endif

// test_floating_point.cpp  The library's mode inside the scope, and the thread's own comes back.
#include <catch2/catch.hpp>
#include <cfenv>

#include "core/floating_point.hpp"

namespace {

float half_of(float value) {
  const volatile float at_run_time = value;
  return at_run_time * 0.5f;
}

float third_of(float value) {
  const volatile float at_run_time = value;
  return at_run_time / 3;
}

}  // namespace

#if defined(__SSE2__) || defined(__aarch64__)
TEST_CASE("denormals_are_flushed_in_the_scope_only") {
  constexpr float kSmallestNormal = 1.17549435e-38f;
  CHECK(half_of(kSmallestNormal) > 0);
  {
    const sinew::core::FloatingPointScope mode;
    CHECK(half_of(kSmallestNormal) == 0);
  }
  CHECK(half_of(kSmallestNormal) > 0);
}

TEST_CASE("rounding_is_to_the_nearest_in_the_scope_and_the_thread_s_own_outside") {
  const float nearest = third_of(1);
  REQUIRE(std::fesetround(FE_DOWNWARD) == 0);
  const float down = third_of(1);
  float inside = 0;
  {
    const sinew::core::FloatingPointScope mode;
    inside = third_of(1);
  }
  const float after = third_of(1);
  std::fesetround(FE_TONEAREST);
  CHECK(down < nearest);
  CHECK(inside == nearest);
  CHECK(after == down);
}
#endif

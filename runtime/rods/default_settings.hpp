// default_settings.hpp  The start for a kind of rod, as measured.
#pragma once
#include "rods/rod_batch.hpp"

namespace sinew::rods {

// What decides; a batch is of one kind.
struct RodKind {
  uint32_t segments = 0;
  float young_pa = 1e6f;
  bool tree = false;
  bool contacts = false;
};

// What was fastest to a residual of 1e-4 for this kind (perf/trade/README.md); all else as RodSettings has
// it. A test holds it to the table of measurements. The direct solver from the last steps' forces continued
// is the fastest on average over each scene that was measured without contacts; in single cases another start
// is up to 1.6 times as fast.
constexpr RodSettings default_settings(const RodKind&) noexcept { return {.start = RodStart::kContinued}; }

}  // namespace sinew::rods

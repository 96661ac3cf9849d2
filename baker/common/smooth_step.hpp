// smooth_step.hpp  A rise without kinks.
#pragma once
#include <algorithm>

namespace sinew::baker {

// 0 up to `low`, 1 from `high` on, and a cubic between that is level at both. low < high.
inline double smooth_step(double low, double high, double value) {
  const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace sinew::baker

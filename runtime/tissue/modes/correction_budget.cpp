// correction_budget.cpp  The largest share of a correction that stays within its budget: a quadratic in s.
#include "tissue/modes/correction_budget.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::tissue {
namespace {

// S(d- + s p, d) = constant + 2 s linear + s^2 square.
struct Energy {
  float constant = 0, linear = 0, square = 0;
};

Energy energy_of(const CorrectionStep& step) {
  Energy sum;
  for (size_t m = 0; m < step.modes.size(); ++m) {
    const pack::ModeRecord& mode = step.modes[m];
    const float weight = 1 / (1 - mode.a1 - mode.a2);
    const float d = step.d[m], p = step.correction[m], goes_on = mode.a1 * d + mode.a2 * step.d_before[m];
    sum.constant += weight * (goes_on * goes_on - mode.a1 * goes_on * d - mode.a2 * d * d);
    sum.linear += weight * p * (goes_on - 0.5f * mode.a1 * d);
    sum.square += weight * p * p;
  }
  return sum;
}

void update_swing(const CorrectionStep& step, float* swing) {
  float kept = 0, squared = 0;
  for (size_t m = 0; m < step.modes.size(); ++m) {
    kept = std::max(kept, -step.modes[m].a2);
    squared += step.base[m] * step.base[m];
  }
  *swing = std::min(kept, 1.0f) * *swing;
  if (!step.pose_stays && std::isfinite(squared)) *swing = std::max(*swing, squared);
}

}  // namespace

float bounded_share(const CorrectionStep& step, float* swing) noexcept {
  update_swing(step, swing);
  const Energy energy = energy_of(step);
  const float room = kMostCorrection * kMostCorrection * *swing - energy.constant;
  if (!(room > 0) || !std::isfinite(energy.square) || !std::isfinite(energy.linear)) return 0;
  if (2 * energy.linear + energy.square <= room) return 1;
  if (!(energy.square > 0)) return 0;
  const float root = std::sqrt(energy.linear * energy.linear + energy.square * room);
  // Of the two forms of the root, the one that subtracts nothing from what is nearly equal.
  const float share =
      energy.linear > 0 ? room / (root + energy.linear) : (root - energy.linear) / energy.square;
  return std::isfinite(share) ? std::clamp(share, 0.0f, 1.0f) : 0.0f;
}

}  // namespace sinew::tissue

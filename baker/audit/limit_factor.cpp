// limit_factor.cpp  see limit_factor.hpp.
#include "baker/audit/limit_factor.hpp"

#include <algorithm>

#include "baker/audit/bounds.hpp"

namespace sinew::baker {
namespace {

// Aimed below a bound by so much, since the whole audit plays more than the quick one.
constexpr double kBelow = 0.85;
constexpr double kLeast = 0.2, kTurnedOver = 0.7;

}  // namespace

double limit_factor(const PartAudit& part, double height_m) {
  double factor = 1;
  const auto bring = [&](double value, double bound) {
    if (value > bound) factor = std::min(factor, kBelow * bound / value);
  };
  bring(part.edge_stretch.value - 1, most_stretch(part.part.is_rod) - 1);
  if (!part.part.is_rod) {
    bring(part.bob_m / height_m, kMostDisplacement);
    if (part.inverted_share.value > most_inverted(part.part)) factor = std::min(factor, kTurnedOver);
  }
  return std::max(factor, kLeast);
}

}  // namespace sinew::baker

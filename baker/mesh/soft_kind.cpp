// soft_kind.cpp  The table of kinds.
#include "baker/mesh/soft_kind.hpp"

#include <array>
#include <cmath>

namespace sinew::baker {
namespace {

// Frequencies of flesh are those that artists tune to; lengths are an adult human's, or a large dog's for
// ears and tails.
constexpr std::array<KindDefaults, static_cast<size_t>(SoftKind::kCount)> kDefaults = {{
    {"other", 3, 0.3},
    {"belly", 3, 0.4},
    {"breast", 3.5, 0.18},
    {"glute", 3.5, 0.25},
    {"thigh", 5, 0.35},
    {"cheek", 6, 0.08},
    {"ear", 3, 0.12},
    {"tail", 2, 0.5},
    {"hair", 2, 0.3},
    {"trunk", 1.5, 0.8},
    {"tentacle", 1.5, 0.8},
    {"antenna", 4, 0.2},
    {"fin", 2.5, 0.3},
    {"cloth", 1.5, 0.6},
    {"hat", 4, 0.35},
}};

}  // namespace

const KindDefaults& defaults_of(SoftKind kind) { return kDefaults[static_cast<size_t>(kind)]; }

double default_frequency_hz(SoftKind kind, double length_m) {
  const KindDefaults& defaults = defaults_of(kind);
  return defaults.frequency_hz * std::sqrt(defaults.length_m / length_m);
}

std::optional<SoftKind> kind_called(const std::string& name) {
  for (size_t kind = 0; kind < kDefaults.size(); ++kind)
    if (name == kDefaults[kind].name) return static_cast<SoftKind>(kind);
  return std::nullopt;
}

}  // namespace sinew::baker

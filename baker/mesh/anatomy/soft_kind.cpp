// soft_kind.cpp  The table of kinds.
#include "baker/mesh/anatomy/soft_kind.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sinew::baker {
namespace {

// Flesh on one side of a bone goes as far as leaves its skin unstretched by more than some two fifths; what
// is soft all around, further. Frequencies of flesh are those that artists tune to; lengths are an adult
// human's, or a large dog's for ears and tails.
constexpr std::array<KindDefaults, static_cast<size_t>(SoftKind::kCount)> kDefaults = {{
    {"other", 3, 0.3, 0.35},
    {"belly", 3, 0.4, 0.14},
    {"breast", 3.5, 0.18, 0.16},
    {"glute", 3.5, 0.25, 0.14},
    {"thigh", 5, 0.35, 0.12},
    {"cheek", 6, 0.08, 0.2},
    {"udder", 2.5, 0.3, 0.2},
    {"hump", 2.5, 0.4, 0.14},
    {"ear", 3, 0.12, 0.35},
    {"tail", 2, 0.5, 0.35},
    {"hair", 2, 0.3, 0.35},
    {"trunk", 1.5, 0.8, 0.35},
    {"tentacle", 1.5, 0.8, 0.35},
    {"antenna", 4, 0.2, 0.35},
    {"fin", 2.5, 0.3, 0.35},
    {"cloth", 1.5, 0.6, 0.35},
    {"hat", 4, 0.35, 0.35},
}};

}  // namespace

const KindDefaults& defaults_of(SoftKind kind) { return kDefaults[static_cast<size_t>(kind)]; }

double default_frequency_hz(SoftKind kind, double length_m) {
  const KindDefaults& defaults = defaults_of(kind);
  return std::min(kMostFrequency_hz, defaults.frequency_hz * std::sqrt(defaults.length_m / length_m));
}

std::optional<SoftKind> kind_called(const std::string& name) {
  for (size_t kind = 0; kind < kDefaults.size(); ++kind)
    if (name == kDefaults[kind].name) return static_cast<SoftKind>(kind);
  return std::nullopt;
}

std::string kind_names() {
  std::string names;
  for (const KindDefaults& kind : kDefaults) names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

}  // namespace sinew::baker

// soft_kind.hpp  What kind of soft part a name stands for, and how fast such a part swings by default.
#pragma once
#include <optional>
#include <string>

namespace sinew::baker {

enum class SoftKind {
  kOther,
  // Soft tissue.
  kBelly,
  kBreast,
  kGlute,
  kThigh,
  kCheek,
  kUdder,
  kHump,
  kEar,
  // Chains of bones that swing as rods; a tail without a chain is soft tissue.
  kTail,
  kHair,
  kTrunk,
  kTentacle,
  kAntenna,
  kFin,
  kCloth,
  kHat,  // a piece of felt or straw, never a chain
  kCount
};

// A part of length_m swings at frequency_hz by default; one of another length L at
// frequency_hz sqrt(length_m / L), so that weight bends every size by the same share of its length.
struct KindDefaults {
  const char* name;  // as tables and a recipe's "kind" have it
  double frequency_hz, length_m;
  double max_displacement;  // of a region's radius
};

const KindDefaults& defaults_of(SoftKind kind);

inline constexpr double kMostFrequency_hz = 25;  // of a region, stated or not

// length_m > 0: of a region its diameter, of a rod its longest chain.
double default_frequency_hz(SoftKind kind, double length_m);

std::optional<SoftKind> kind_called(const std::string& name);  // by KindDefaults::name
std::string kind_names();                                      // of all, for messages

}  // namespace sinew::baker

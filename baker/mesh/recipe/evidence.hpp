// evidence.hpp  Why a part of a character swings, or does not.
#pragma once
#include <string>
#include <vector>

#include "baker/mesh/anatomy/soft_kind.hpp"

namespace sinew::baker {

// From the strongest on: what a stronger one claims, a weaker one leaves.
enum class Evidence { kRecipe, kPainted, kSpringBone, kBoneName, kMeshName, kMaterialName, kShape };

constexpr const char* name_of(Evidence evidence) {
  constexpr const char* kNames[] = {"recipe",    "painted",       "spring bone", "bone name",
                                    "mesh name", "material name", "shape"};
  return kNames[static_cast<size_t>(evidence)];
}

// What evidence points at and stays rigid.
struct SkippedPart {
  std::string part;
  Evidence evidence = Evidence::kBoneName;
  SoftKind kind = SoftKind::kOther;
  std::string why;  // and what to do about it
};

}  // namespace sinew::baker

// displacement_bound.hpp  How far from its skinned place a vertex may be shown at most, whatever poses,
// contacts, parameters, levels and frame rates do: the last thing that is done to what is read.
//
// A vertex stays within kMostShown of the bind pose's largest extent, in the bind pose; a pose that scales
// its joints scales that too. Each of the regions that carry a vertex has an equal part of it. Up to
// tissue::kFreeShare of that nothing is changed, from there a displacement approaches it smoothly, so that
// nothing is seen to stop. Baked limits (tissue/modes/guard.hpp) are mostly far below: what presses, what
// adds up, and parameters beyond what was baked come near it.
#pragma once
#include <Eigen/Core>

#include "character/asset/asset.hpp"

namespace sinew::world {

inline constexpr float kMostShown = 0.5f;  // of the largest extent

// Of what one region carries.
float displacement_bound_m(const Asset& asset, size_t region) noexcept;
Eigen::Vector3f within_bound(const Eigen::Vector3f& displacement_m, float bound_m) noexcept;
// Of a region's columns, [3][padded]; what is not finite is not displaced.
void hold_within_bound(float bound_m, size_t padded, float* carried) noexcept;

}  // namespace sinew::world

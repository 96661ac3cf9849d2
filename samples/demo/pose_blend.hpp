// pose_blend.hpp  Between two poses.
#pragma once
#include <span>

#include "pack/format.hpp"
#include "sinew/types.hpp"

namespace sinew::demo {

// For poses a frame apart: matrices mixed entry by entry.
void mix_near(std::span<const float> a, std::span<const float> b, float t, std::span<Matrix34> out);
// For any two poses: each joint turns and moves relative to its parent, so that limbs keep their length. out
// may be a or b.
void mix_far(std::span<const pack::JointRecord> joints, std::span<const Matrix34> a,
             std::span<const Matrix34> b, float t, std::span<Matrix34> out);

}  // namespace sinew::demo

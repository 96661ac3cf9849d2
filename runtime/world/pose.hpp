// pose.hpp  Poses: checked on entry, interpolated at ticks, made into skin matrices.
#pragma once
#include <cstdint>
#include <span>

#include "pack/format.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

// kInvalidArgument: count or range; kNotFinite: names the joint. *root: the pose's, its quaternion
// normalised.
Status check_pose(const Pose& pose, uint32_t joint_count, RootTransform* root) noexcept;
Status check_root(const RootTransform& given, RootTransform* root) noexcept;

// A joint matrix M = (R S, t): R a rotation by Gram-Schmidt, S = R^T M what is left (scale, shear,
// mirroring), so that nothing is lost at the ends of an interpolation.
struct JointParts {
  float rotation_xyzw[4];
  float stretch[9];  // row-major
  float translation_m[3];
};

JointParts split_joint(const Matrix34& joint) noexcept;
// Rotation on the shorter arc, stretch and translation linear. share 0: a, 1: b; outside: extrapolated.
Matrix34 blend_joint(const JointParts& a, const JointParts& b, float share) noexcept;
RootTransform blend_root(const RootTransform& a, const RootTransform& b, double share) noexcept;

// skin[j] = joints[j] x inverse bind[j], [joints][12].
void skin_matrices(std::span<const pack::JointRecord> records, const Matrix34* joints, float* skin) noexcept;
// joints[j] = the bind pose: the inverse of inverse_bind; identity where that is singular.
void bind_pose(std::span<const pack::JointRecord> records, Matrix34* joints) noexcept;

}  // namespace sinew::world

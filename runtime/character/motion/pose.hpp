// pose.hpp  Poses: checked on entry, interpolated at ticks, made into skin matrices.
#pragma once
#include <cstdint>
#include <span>

#include "pack/format.hpp"
#include "sinew/export.h"
#include "sinew/types.hpp"

namespace sinew::world {

// kInvalidArgument: count or range; kNotFinite: names the joint. *root: the pose's, its quaternion
// normalised.
Status check_pose(const Pose& pose, uint32_t joint_count, RootTransform* root) noexcept;
// SINEW_API: sinew::embree asks, too.
SINEW_API Status check_root(const RootTransform& given, RootTransform* root) noexcept;
bool same_root(const RootTransform& a, const RootTransform& b) noexcept;  // bit for bit
// A checked root, or space, as an instance keeps it: its place in metres of the character's, of which the
// world has `scale` each. So all that is simulated is of the size that was baked; places and lengths that
// leave or come from the world are multiplied or divided by root.scale where they do.
RootTransform in_own_metres(RootTransform root, double scale) noexcept;

// A joint matrix M = (R S, t): R a rotation by Gram-Schmidt, S = R^T M what is left (scale, shear,
// mirroring), so that nothing is lost at the ends of an interpolation.
struct JointParts {
  float rotation_xyzw[4];
  float stretch[9];  // row-major
  float translation_m[3];
};

// The rotation alone, x y z w; none where the matrix has no three directions.
void joint_rotation(const Matrix34& joint, double out_xyzw[4]) noexcept;
JointParts split_joint(const Matrix34& joint) noexcept;

// A place between two poses a and b, c the pose before a and d the one before c:
// a + next (b - a) + past (a - c) + older (c - d), rotations through their logarithms.
struct PathWeights {
  double next = 1, past = 0, older = 0;
};

// share: 0 at a, 1 at b, which is met exactly. The path is the cubic through d, c, a and b where c is
// dt_before_s old, d dt_older_s before it, and frame times are alike; the parabola through c, a and b where d
// is unknown, else the line from a to b. On the line all of a change of velocity falls into one tick, and at
// 15 frames a second what a 2 Hz motion moves of flesh at 4 Hz is 9 % off; on the parabola 4 %, on the cubic
// 2 %.
PathWeights path_weights(double share, double dt_s, double dt_before_s, double dt_older_s = 0) noexcept;

Matrix34 joint_between(const JointParts& d, const JointParts& c, const JointParts& a, const JointParts& b,
                       const PathWeights& weights) noexcept;
// A step as a displacement in the world and a rotation vector in the axes of its begin.
struct RootStep {
  double place_m[3], turn[3];
};
RootTransform root_between(const RootStep& older, const RootStep& before, const RootTransform& a,
                           const RootTransform& b, const PathWeights& weights) noexcept;

// skin[j] = joints[j] x inverse bind[j], [joints][12].
void skin_matrices(std::span<const pack::JointRecord> records, const Matrix34* joints, float* skin) noexcept;
// joints[j] = the bind pose: the inverse of inverse_bind; identity where that is singular.
void bind_pose(std::span<const pack::JointRecord> records, Matrix34* joints) noexcept;

}  // namespace sinew::world

// constraints.hpp  A joint's two constraints, each a pure function: value and derivatives.
//
// What the kernels in kernels/rods/rod_*-inl.hpp compute in vectors, said once plainly; tests hold the
// kernels to it and measure with it. A pose's rotation is a vector along the segment's own axes, q -> q (1,
// rotation / 2). Both return false, and leave `out` alone, for what has no constraint: numbers that are not
// finite, a length of 0, an orientation that is no rotation (length off by more than a thousandth).
#pragma once

namespace sinew::rods {

struct JointEnd {
  double position_m[3];
  double orientation[4];  // x y z w
  double length_m;
};

// Derivatives by position and rotation of parent and child, row by row.
struct Constraint {
  double value[3];
  double by_parent_position[3][3], by_parent_rotation[3][3];
  double by_child_position[3][3], by_child_rotation[3][3];
};

// Stretch and shear, metres in the world: x_a + l_a/2 z_a - x_b + l_b/2 z_b (Kugelstadt & Schoemer 2016, Eq.
// 3, held where segments meet as Deul et al. 2018, Eq. 8).
bool stretch_shear(const JointEnd& parent, const JointEnd& child, Constraint* out) noexcept;

// Bend and twist: 2 Im(conj(q_a) q_b) - rest, the Darboux vector (the same, Eq. 8) times the joint's length.
bool bend_twist(const JointEnd& parent, const JointEnd& child, const double rest[3],
                Constraint* out) noexcept;

// The rest of a joint whose present shape is its shape at rest.
bool darboux(const JointEnd& parent, const JointEnd& child, double out[3]) noexcept;

}  // namespace sinew::rods

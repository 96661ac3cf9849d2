// section.hpp  Mass, inertia and compliances of round segments and their joints.
#pragma once
#include "rods/strand.hpp"

namespace sinew::rods {

// A segment's axial inertia is never below this share of the other two: thinner ones would spin about
// themselves faster than single precision follows. Statics do not see it; torsional waves run slower in rods
// thinner than 1/77 of a segment's length.
inline constexpr double kLeastAxialInertia = 1e-3;

struct SegmentInertia {
  double mass_kg;
  double inertia_kg_m2;        // about the middle, across the axis: m (3 r^2 + l^2) / 12
  double axial_inertia_kg_m2;  // m r^2 / 2, or kLeastAxialInertia of the other
};
SegmentInertia segment_inertia(const SegmentDef& segment) noexcept;

// Kugelstadt & Schoemer 2016, Eq. 10 for round sections, over l, the mean of both lengths, r the mean of
// both radii, A = pi r^2, I = pi r^4 / 4:
struct JointCompliance {
  double stretch_m_n;   // l / (stretch modulus A); 0 for a rod that does not stretch
  double bend_rad_nm;   // l / (E I)
  double twist_rad_nm;  // l / (2 G I)
};
JointCompliance joint_compliance(const SegmentDef& parent, const SegmentDef& child) noexcept;

}  // namespace sinew::rods

// section.cpp  Mass, inertia and compliances of round segments and their joints.
#include "rods/section.hpp"

#include <algorithm>
#include <numbers>

namespace sinew::rods {

SegmentInertia segment_inertia(const SegmentDef& s) noexcept {
  const double r = s.radius_m, l = s.length_m;
  const double mass = s.density_kg_m3 * std::numbers::pi * r * r * l;
  const double across = mass * (3 * r * r + l * l) / 12;
  return {mass, across, std::max(mass * r * r / 2, kLeastAxialInertia * across)};
}

JointCompliance joint_compliance(const SegmentDef& parent, const SegmentDef& child) noexcept {
  const double l = 0.5 * (static_cast<double>(parent.length_m) + child.length_m);
  const double r = 0.5 * (static_cast<double>(parent.radius_m) + child.radius_m);
  const double area = std::numbers::pi * r * r, second_moment = area * r * r / 4;
  return {l / (child.stretch_modulus_pa * area), l / (child.young_modulus_pa * second_moment),
          l / (2 * child.torsion_modulus_pa * second_moment)};
}

}  // namespace sinew::rods

// test_section.cpp  Sections against the textbook's formulas.
#include "rods/section.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace sinew;

namespace {

rods::SegmentDef segment() {
  rods::SegmentDef s;
  s.length_m = 0.5f;
  s.radius_m = 0.125f;
  s.density_kg_m3 = 2000;
  s.young_modulus_pa = 3e6f;
  s.torsion_modulus_pa = 1e6f;
  return s;
}

}  // namespace

TEST_CASE("a_segment_is_a_full_cylinder") {
  const rods::SegmentInertia i = rods::segment_inertia(segment());
  const double mass = 2000 * std::numbers::pi * 0.125 * 0.125 * 0.5;
  CHECK(i.mass_kg == Approx(mass).epsilon(1e-12));
  CHECK(i.axial_inertia_kg_m2 == Approx(mass * 0.125 * 0.125 / 2).epsilon(1e-12));
  CHECK(i.inertia_kg_m2 == Approx(mass * (3 * 0.125 * 0.125 + 0.25) / 12).epsilon(1e-12));
}

TEST_CASE("a_hair_keeps_a_thousandth_of_its_inertia_about_itself") {
  rods::SegmentDef hair = segment();
  hair.radius_m = 4e-5f;
  const rods::SegmentInertia i = rods::segment_inertia(hair);
  CHECK(i.axial_inertia_kg_m2 == Approx(1e-3 * i.inertia_kg_m2).epsilon(1e-12));
}

TEST_CASE("a_joint_bends_as_its_section_and_both_halves_lengths_say") {
  rods::SegmentDef parent = segment(), child = segment();
  parent.length_m = 1.5f;
  parent.radius_m = 0.375f;
  const rods::JointCompliance c = rods::joint_compliance(parent, child);
  const double l = 1, r = 0.25, second_moment = std::numbers::pi * std::pow(r, 4) / 4;
  CHECK(c.bend_rad_nm == Approx(l / (3e6 * second_moment)).epsilon(1e-12));
  CHECK(c.twist_rad_nm == Approx(l / (1e6 * 2 * second_moment)).epsilon(1e-12));
  CHECK(c.stretch_m_n == 0);
  child.stretch_modulus_pa = 2e6f;
  CHECK(rods::joint_compliance(parent, child).stretch_m_n ==
        Approx(l / (2e6 * std::numbers::pi * r * r)).epsilon(1e-12));
}

// test_create_batch.cpp  Which strands and settings make a batch.
#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

struct BadSetting {
  const char* expected;
  std::function<void(test::RodSettings&)> spoil;
};

const BadSetting kBad[] = {
    {"RodSettings::start is 9", [](test::RodSettings& s) { s.start = static_cast<rods::RodStart>(9); }},
    {"RodSettings::start is 1; give kContinued",
     [](test::RodSettings& s) {
       s.correction.correct = [](void*, const simd::RodJob&, const simd::RodStartJob&, uint32_t) {};
     }},
    {"RodSettings::max_iterations is 0", [](test::RodSettings& s) { s.max_iterations = 0; }},
    {"RodSettings::max_iterations is 1001", [](test::RodSettings& s) { s.max_iterations = 1001; }},
    {"RodSettings::tolerance_rad is 0", [](test::RodSettings& s) { s.tolerance_rad = 0; }},
    {"RodSettings::tolerance_rad is nan", [](test::RodSettings& s) { s.tolerance_rad = std::nanf(""); }},
    {"RodSettings::teleport_lengths is 0", [](test::RodSettings& s) { s.teleport_lengths = 0; }},
    {"RodSettings::teleport_lengths is inf", [](test::RodSettings& s) { s.teleport_lengths = HUGE_VALF; }},
    {"RodSettings::gravity_m_s2 is inf", [](test::RodSettings& s) { s.gravity_m_s2[2] = HUGE_VALF; }},
};

// Each number by itself is in its range; in a strand's own units it is 0 or leaves float's range.
struct OutOfRange {
  const char* expected;
  std::function<void(test::Segments&)> spoil;
};

const OutOfRange kOutOfRange[] = {
    {"strand 1, segment 2: its mass in kg", [](test::Segments& s) { s[2].radius_m = 1e-25f; }},
    {"strand 1, segment 2: its mass in kg",
     [](test::Segments& s) { s[2].density_kg_m3 = s[2].radius_m = 3e38f; }},
    {"strand 1, segment 0: its mass over the strand's mean",
     [](test::Segments& s) { s[0].density_kg_m3 = 1e-30f, s[2].density_kg_m3 = 1e20f; }},
    {"strand 1, segment 2: its inertia over", [](test::Segments& s) { s[2].density_kg_m3 = 1.6e-35f; }},
    {"strand 1, segment 2: its axial inertia over", [](test::Segments& s) { s[2].density_kg_m3 = 1e-33f; }},
    {"strand 1, segment 3: its joint's bending compliance",
     [](test::Segments& s) { s[3].young_modulus_pa = 1e-37f; }},
    {"strand 1, segment 3: its joint's twisting compliance",
     [](test::Segments& s) { s[3].torsion_modulus_pa = 1e-37f; }},
    {"strand 1, segment 1: its joint's bending compliance",
     [](test::Segments& s) {
       for (auto& x : s) x.density_kg_m3 = 1, x.radius_m = 50;
       s[1].young_modulus_pa = 3e38f;
     }},
    {"strand 1, segment 1: its joint's stretching compliance",
     [](test::Segments& s) {
       for (auto& x : s) x.density_kg_m3 = 1;
       s[1].stretch_modulus_pa = 3e38f;
     }},
    {"strand 1, segment 0: the strand's mean mass times length^2",
     [](test::Segments& s) {
       s = test::straight_rod({.segments = 4, .length_m = 4e-10, .radius_m = 1e-8f});
     }},
};

}  // namespace

TEST_CASE("bad_settings_and_strands_make_no_batch_and_leave_the_old_one_alone") {
  const test::Segments good = test::straight_rod({.segments = 4});
  test::RodBatch batch = test::batch_of({good});
  REQUIRE(batch.segment_count() == 4);
  const auto refused = [&](const std::vector<test::Segments>& strands, const test::RodSettings& settings,
                           const std::string& expected) {
    const Status status = test::try_batch(strands, settings, &batch);
    INFO(expected << " | " << status.message);
    CHECK_FALSE(status.ok());
    CHECK(std::string(status.message).find(expected) != std::string::npos);
    CHECK(batch.segment_count() == 4);
    CHECK(batch.strand_count() == 1);
  };
  for (const BadSetting& bad : kBad) {
    test::RodSettings settings;
    bad.spoil(settings);
    refused({good, good}, settings, bad.expected);
  }
  refused({}, {}, "no strand");
  refused({good, test::straight_rod({.segments = 5})}, {}, "strand 1: 5 segments where strand 0 has 4");
  test::Segments branched = good;
  branched[3].parent = 1;
  branched[3].position_m[0] = branched[2].position_m[0];
  refused({good, branched}, {}, "strand 1, segment 3: its parent is 1 where strand 0 has 2");
  test::Segments soft = good;
  soft[2].young_modulus_pa = 0;
  refused({good, soft}, {}, "strand 1, segment 2: young_modulus_pa is 0");
  for (const OutOfRange& bad : kOutOfRange) {
    test::Segments spoilt = good;
    bad.spoil(spoilt);
    refused({good, spoilt}, {}, bad.expected);
  }
  const test::Segments small = test::straight_rod({.segments = 4, .length_m = 0.4});
  refused({good, small}, {.gravity_m_s2 = {0, 3e38f, 0}}, "strand 1, segment 0: gravity over");
}

TEST_CASE("a_batch_begins_in_the_shape_it_was_given") {
  std::vector<test::Segments> strands(7, test::helix(9));
  for (size_t s = 0; s < strands.size(); ++s) {
    for (auto& segment : strands[s]) segment.position_m[1] += 1e4 * static_cast<double>(s);
  }
  const test::RodBatch batch = test::batch_of(strands);
  REQUIRE(batch.strand_count() == 7);
  for (uint32_t s = 0; s < 7; ++s) {
    for (uint32_t i = 0; i < 9; ++i) {
      const rods::SegmentPose pose = batch.pose(s, i);
      // Relative to the strand's root a place is two floats, so 60 km away costs what double costs.
      CHECK(test::distance(pose.position_m, strands[s][i].position_m) < 1e-10);
      for (size_t k = 0; k < 4; ++k)
        CHECK(std::fabs(pose.orientation[k] - strands[s][i].orientation[k]) < 1e-6f);
    }
  }
}

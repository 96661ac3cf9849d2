// test_check_strand.cpp  What is refused, by name and place.
#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <string>

#include "tests/rods/rod_scenes.hpp"

using namespace sinew;

namespace {

struct BadStrand {
  const char* expected;
  std::function<void(test::Segments&)> spoil;
};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const BadStrand kBad[] = {
    {"strand 3: 1 segments", [](test::Segments& s) { s.resize(1); }},
    {"strand 3: 0 segments", [](test::Segments& s) { s.clear(); }},
    {"segment 2: young_modulus_pa is 0", [](test::Segments& s) { s[2].young_modulus_pa = 0; }},
    {"segment 2: young_modulus_pa is -1", [](test::Segments& s) { s[2].young_modulus_pa = -1; }},
    {"segment 2: young_modulus_pa is nan", [](test::Segments& s) { s[2].young_modulus_pa = kNan; }},
    {"segment 1: torsion_modulus_pa is -5", [](test::Segments& s) { s[1].torsion_modulus_pa = -5; }},
    {"segment 4: stretch_modulus_pa is 0", [](test::Segments& s) { s[4].stretch_modulus_pa = 0; }},
    {"segment 4: damping_s is -1", [](test::Segments& s) { s[4].damping_s = -1; }},
    {"segment 0: drag_per_s is -2", [](test::Segments& s) { s[0].drag_per_s = -2; }},
    {"segment 3: length_m is 0", [](test::Segments& s) { s[3].length_m = 0; }},
    {"segment 3: radius_m is 0", [](test::Segments& s) { s[3].radius_m = 0; }},
    {"segment 3: radius_m is inf", [](test::Segments& s) { s[3].radius_m = HUGE_VALF; }},
    {"segment 3: density_kg_m3 is -1", [](test::Segments& s) { s[3].density_kg_m3 = -1; }},
    {"segment 2: position_m is nan", [](test::Segments& s) { s[2].position_m[1] = std::nan(""); }},
    {"segment 2: the length of orientation is 0",
     [](test::Segments& s) { s[2].orientation[1] = s[2].orientation[3] = 0; }},
    {"segment 2: the length of orientation is nan", [](test::Segments& s) { s[2].orientation[0] = kNan; }},
    {"segment 0: the root's parent is 1", [](test::Segments& s) { s[0].parent = 1; }},
    {"segment 2: no parent", [](test::Segments& s) { s[2].parent = rods::kNoParent; }},
    {"segment 2: parent is 99; there is no such segment", [](test::Segments& s) { s[2].parent = 99; }},
    {"segment 2: parent is 2; these parents form a cycle", [](test::Segments& s) { s[2].parent = 2; }},
    {"segment 2: parent is 4; these parents form a cycle",
     [](test::Segments& s) { s[2].parent = 4; }},  // 4's parent is 3, and 3's is 2
    {"segment 2: parent is 4; list a parent before its children",
     [](test::Segments& s) {
       s[2].parent = 4;
       s[3].parent = s[4].parent = 1;
     }},
    {"segment 3: the gap in metres to its parent's end is 0.5",
     [](test::Segments& s) { s[3].position_m[2] = 0.5; }},
};

}  // namespace

TEST_CASE("bad_strands_are_refused_by_name_and_place") {
  for (const BadStrand& bad : kBad) {
    test::Segments segments = test::straight_rod({.segments = 5});
    bad.spoil(segments);
    const Status status = rods::check_strand({segments}, 3);
    INFO(bad.expected << " | " << status.message);
    CHECK_FALSE(status.ok());
    CHECK(std::string(status.message).find(bad.expected) != std::string::npos);
    CHECK(std::string(status.message).find("strand 3") == 0);
    CHECK(std::string(status.message).find('\n') == std::string::npos);
  }
}

TEST_CASE("good_strands_are_taken") {
  CHECK(rods::check_strand({test::straight_rod({.segments = 2})}, 0).ok());
  CHECK(rods::check_strand({test::helix(100)}, 0).ok());
  test::Segments tree = test::straight_rod({.segments = 5});
  tree[4].parent = 2;
  tree[4].position_m[0] = tree[3].position_m[0];
  CHECK(rods::check_strand({tree}, 0).ok());
}

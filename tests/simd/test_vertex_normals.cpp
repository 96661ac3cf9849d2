// test_vertex_normals.cpp  Smooth across seams, weighted by area, unit.
#include "simd/vertex_normals.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace sinew;

namespace {

constexpr float kRounding = 1e-6f;

//   3-------2        two faces of a box corner, seen from +x +y +z; vertices 4, 5 are twins of 0, 1 (a seam)
//   |  +z   |        the second face lies below, along -z
//   0-------1
//   4-------5
//      -y
const std::vector<float> kPositions = {0, 0, 0, 1, 0, 0, 1,  1, 0, 0,  1, 0, 0, 0,
                                       0, 1, 0, 0, 1, 0, -1, 0, 0, -1, 9, 9, 9};
const std::vector<uint32_t> kTriangles = {0, 1, 2, 0, 2, 3, 7, 6, 5, 7, 5, 4};
const std::vector<uint32_t> kWelded = {0, 1, 2, 3, 0, 1, 6, 7, 8};

std::vector<float> normals_of(const std::vector<float>& positions) {
  std::vector<float> out(positions.size(), 5);
  simd::vertex_normals({positions.data(), 12, kTriangles, kWelded, out.data(), 12});
  return out;
}

}  // namespace

TEST_CASE("vertex_normals_are_unit_and_equal_on_both_sides_of_a_seam") {
  const std::vector<float> n = normals_of(kPositions);
  for (size_t v = 0; v < 8; ++v) {
    const float length =
        std::sqrt(n[3 * v] * n[3 * v] + n[3 * v + 1] * n[3 * v + 1] + n[3 * v + 2] * n[3 * v + 2]);
    REQUIRE(length == Approx(1).margin(kRounding));
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    REQUIRE(n[axis] == n[12 + axis]);
    REQUIRE(n[3 + axis] == n[15 + axis]);
  }
  REQUIRE((n[8] == Approx(1).margin(kRounding) && n[7] == Approx(0).margin(kRounding)));     // vertex 2: +z
  REQUIRE((n[19] == Approx(-1).margin(kRounding) && n[20] == Approx(0).margin(kRounding)));  // vertex 6: -y
  REQUIRE(n[1] < 0);
  REQUIRE(n[2] > 0);
}

TEST_CASE("vertex_without_a_triangle_with_area_has_a_zero_normal") {
  const std::vector<float> n = normals_of(kPositions);
  const std::vector<float> flat = normals_of(std::vector<float>(27, 1.0f));
  for (size_t axis = 0; axis < 3; ++axis) REQUIRE(n[24 + axis] == 0);
  for (const float value : flat) REQUIRE(value == 0);
}

// test_voxel_body.cpp  Bodies of voxels: whole, held, and as heavy as their shape.
#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

#include "baker/patches/voxel_body.hpp"

using namespace sinew;
using baker::BodyShape;
using baker::VoxelBody;

namespace {

double volume(const VoxelBody& body, const std::array<int, 4>& t) {
  const auto at = [&](size_t k) { return body.nodes[static_cast<size_t>(t[k])]; };
  return (at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0)) / 6;
}

VoxelBody drawn(BodyShape shape, double size, uint64_t seed) {
  baker::Random random(seed);
  return baker::make_body(shape, size, random);
}

}  // namespace

TEST_CASE("every_body_has_upright_tetrahedra_and_is_held_in_part") {
  for (const BodyShape shape :
       {BodyShape::kSphere, BodyShape::kCylinder, BodyShape::kEar, BodyShape::kSlab, BodyShape::kLimb})
    for (uint64_t seed = 1; seed < 6; ++seed) {
      const VoxelBody body = drawn(shape, 4, seed);
      for (const auto& t : body.tetrahedra)
        REQUIRE(volume(body, t) > 0.1);  // a sixth, the middle one a third
      const auto held = std::ranges::count(body.constrained, true);
      CHECK(held > 2);
      CHECK(held < static_cast<long>(body.nodes.size()));
    }
}

TEST_CASE("tetrahedra_of_neighbouring_voxels_share_their_faces") {
  const VoxelBody body = drawn(BodyShape::kSphere, 3, 1);
  std::multiset<std::array<int, 3>> faces;
  for (const auto& t : body.tetrahedra)
    for (size_t out = 0; out < 4; ++out) {
      std::array<int, 3> face{};
      for (size_t k = 0, at = 0; k < 4; ++k)
        if (k != out) face[at++] = t[k];
      std::ranges::sort(face);
      faces.insert(face);
    }
  // Two tetrahedra meet at each but the outermost: a body of n voxels has 2 outer faces a voxel side.
  size_t alone = 0;
  for (const auto& face : faces) {
    REQUIRE(faces.count(face) <= 2);
    alone += faces.count(face) == 1;
  }
  CHECK(alone % 2 == 0);
  CHECK(alone < faces.size() / 4);
}

TEST_CASE("a_sphere_weighs_what_a_sphere_weighs") {
  constexpr double kRadius = 5, kSampled = 0.02;  // 64 places a voxel
  const VoxelBody body = drawn(BodyShape::kSphere, kRadius, 1);
  double mass = 0;
  for (size_t e = 0; e < body.tetrahedra.size(); ++e) mass += body.fill[e] * volume(body, body.tetrahedra[e]);
  const double wanted = 4.0 / 3 * M_PI * kRadius * kRadius * kRadius;
  CHECK(std::abs(mass / wanted - 1) < kSampled);
}

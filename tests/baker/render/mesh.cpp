// mesh.cpp  Smooth normals.
#include <catch2/catch.hpp>

#include "baker/render/mesh.hpp"
#include "tests/baker/render/shapes.hpp"

using namespace sinew::render;

TEST_CASE("degenerate_triangles_give_unit_normals") {
  const std::vector<Eigen::Vector3f> points(3, Eigen::Vector3f::Ones());
  const std::vector<std::array<uint32_t, 3>> triangles = {{0, 1, 2}};
  for (const Eigen::Vector3f& n : smooth_normals(points, triangles)) CHECK(n.norm() == Approx(1));
}

TEST_CASE("normals_of_a_sphere_point_outwards") {
  const Mesh mesh = sinew::test::sphere({0, 0, 0}, 1, Rgb::Ones(), 32);
  const auto normals = smooth_normals(mesh.positions, mesh.triangles);
  const size_t ring = 64;  // the poles' copies see one triangle each
  for (size_t v = ring; v + ring < normals.size(); ++v) CHECK(normals[v].dot(mesh.normals[v]) > 0.998f);
}

TEST_CASE("welded_vertices_share_a_normal") {
  // A right-angled roof, its ridge doubled.
  const std::vector<Eigen::Vector3f> points = {{0, 1, 0}, {0, 1, 1}, {-1, 0, 0},
                                               {0, 1, 0}, {0, 1, 1}, {1, 0, 0}};
  const std::vector<std::array<uint32_t, 3>> triangles = {{0, 2, 1}, {3, 4, 5}};
  const auto apart = smooth_normals(points, triangles);
  CHECK(apart[0] != apart[3]);
  const std::vector<uint32_t> welded = {0, 1, 2, 0, 1, 5};
  const auto joined = smooth_normals(points, triangles, welded);
  CHECK(joined[0] == joined[3]);
  CHECK(joined[0].dot(Eigen::Vector3f::UnitY()) == Approx(1).epsilon(1e-5));
}

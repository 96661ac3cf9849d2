// remesh.cpp  Remeshing keeps the topology and the surface, and meets the number of vertices.
#include "baker/creature/remesh.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace sinew::baker;
using Eigen::Vector3d;

namespace {

BodyField egg() {
  BodyPart part;
  part.solid.radii = {0.2, 0.3, 0.2};
  return BodyField({part});
}

double quality(const Surface& surface, const std::array<int, 3>& t) {  // 1 for an equilateral triangle
  const auto at = [&](size_t i) { return surface.positions[static_cast<size_t>(t[i % 3])]; };
  double edges = 0;
  for (size_t i = 0; i < 3; ++i) edges += (at(i + 1) - at(i)).squaredNorm();
  return 2 * std::sqrt(3.0) * (at(1) - at(0)).cross(at(2) - at(0)).norm() / edges;
}

}  // namespace

TEST_CASE("remeshing_meets_the_count_with_good_triangles_on_the_surface") {
  const BodyField field = egg();
  const Surface start =
      contour([&](const Vector3d& p) { return field.sample(p).distance; }, field.bounds(), 0.03);
  for (size_t vertices : {300u, 1000u, 4000u}) {
    const Surface mesh = remesh(field, start, vertices);
    CHECK(why_not_a_sphere(mesh) == "");
    CHECK(static_cast<double>(mesh.positions.size()) == Approx(static_cast<double>(vertices)).epsilon(0.05));
    double worst = 1;
    for (const auto& t : mesh.triangles) worst = std::min(worst, quality(mesh, t));
    constexpr double kWellShaped = 0.5;
    CHECK(worst > kWellShaped);
    for (const Vector3d& p : mesh.positions) CHECK(std::abs(field.sample(p).distance) < 1e-4);
  }
}

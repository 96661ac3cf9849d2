// test_convex.cpp  Signed distances of points against the shapes themselves.
#include "adapters/bullet/convex.hpp"

#include <random>

#include "tests/bullet/probes.hpp"

using namespace sinew;
using namespace sinew::bullet;
using rods::Vector;

namespace {

btVector3 bullet_vector(const Vector& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Vector random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> any(-size, size);
  return {any(random), any(random), any(random)};
}

// Going back by the distance along the normal leads to the surface, and no point of the shape is nearer: none
// reaches further along the normal.
void check_distances(const btConvexShape& shape, double exact_m) {
  const Convex convex = convex_of(shape);
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const Vector p = random_point(random, 1.5);
    const Distance d = distance(convex, p);
    REQUIRE(std::isfinite(d.m));
    CHECK(rods::length(d.normal) == Approx(1).margin(1e-6));
    const Vector surface = rods::scaled_sum(-d.m, d.normal, p);
    CHECK(distance(convex, surface).m == Approx(0).margin(exact_m));
    if (convex.kind == Convex::kOther) continue;
    const btVector3 furthest = shape.localGetSupportingVertex(bullet_vector(d.normal));
    const double reach = rods::dot({furthest.x(), furthest.y(), furthest.z()}, d.normal);
    // Bullet's own cylinder is rounded by its margin of 4 cm.
    const double rounded = convex.kind == Convex::kCylinder ? 0.04 * (std::sqrt(2.0) - 1) : 0;
    if (d.m > 0) CHECK(reach <= rods::dot(surface, d.normal) + exact_m + 1e-5);
    if (d.m > 0) CHECK(reach >= rods::dot(surface, d.normal) - rounded - exact_m - 1e-5);
  }
}

}  // namespace

TEST_CASE("shapes_without_volume_have_none_and_flat_triangles_are_none") {
  const float nan = std::nanf("");
  CHECK_FALSE(convex_of(btSphereShape(0)).has_volume());
  CHECK_FALSE(convex_of(btSphereShape(nan)).has_volume());
  CHECK_FALSE(convex_of(btCapsuleShape(0, 1)).has_volume());
  CHECK_FALSE(convex_of(btConvexHullShape()).has_volume());
  btBoxShape box(btVector3(1, 1, 1));
  box.setLocalScaling({1, 0, 1});
  CHECK_FALSE(convex_of(box).has_volume());
  CHECK(convex_of(btBoxShape(btVector3(1, 1, 1))).has_volume());
  const Vector a = {0, 0, 0}, b = {1, 0, 0}, c = {2, 0, 0}, up = {0, 1, 0};
  CHECK_FALSE(is_triangle({{a, b, c}, 0}));
  CHECK_FALSE(is_triangle({{a, a, a}, 0}));
  CHECK_FALSE(is_triangle({{a, b, {0, std::nan(""), 0}}, 0}));
  CHECK(is_triangle({{a, b, up}, 0}));
}

TEST_CASE("distances_of_closed_forms_lead_to_the_surface") {
  check_distances(btSphereShape(0.7f), 1e-7);
  check_distances(btBoxShape(btVector3(0.5f, 0.2f, 0.9f)), 1e-7);
  check_distances(btCapsuleShapeZ(0.3f, 1.0f), 1e-7);
  check_distances(btCylinderShapeX(btVector3(0.6f, 0.4f, 0.4f)), 1e-7);
}

TEST_CASE("distances_by_gjk_and_epa_lead_to_the_surface") {
  btConvexHullShape hull;
  for (const Vector& p :
       {Vector{1, 0, 0}, {-1, 0, 0}, {0, 0.6, 0}, {0, -0.5, 0}, {0, 0, 0.8}, {0, 0, -0.8}}) {
    hull.addPoint(bullet_vector(p));
  }
  hull.setMargin(0.02f);
  check_distances(hull, 1e-3);  // EPA's accuracy
  check_distances(btConeShape(0.5f, 1.0f), 1e-3);
}

TEST_CASE("a_triangle_s_nearest_point_is_the_nearest_of_many") {
  const Triangle t = {{Vector{0, 0, 0}, Vector{1, 0.1, 0}, Vector{0.3, 0.8, 0.4}}, 0};
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    const Vector p = random_point(random, 1.5);
    double least = 1e9;
    for (int u = 0; u <= 100; ++u) {
      for (int v = 0; u + v <= 100; ++v) {
        const Vector on =
            rods::sum(rods::scaled(0.01 * u, t.corners[1]), rods::scaled(0.01 * v, t.corners[2]));
        least = std::min(least, rods::length(rods::difference(p, on)));
      }
    }
    const double d = distance(convex_of(t), p).m;
    CHECK(d <= least + 1e-12);
    CHECK(d >= least - 0.01);  // the points' spacing
  }
}

// Bullet's GJK by itself is a centimetre off here.
TEST_CASE("a_hull_s_distance_is_exact_to_a_hundredth_of_its_thickness_near_and_far") {
  const Vector half = {0.005, 0.15, 0.005};
  btConvexHullShape hull;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1}) hull.addPoint(bullet_vector({x * half[0], y * half[1], z * half[2]}));
  hull.setMargin(0.001f);
  const Convex convex = convex_of(hull), box = {.kind = Convex::kBox, .size = half};
  std::mt19937 random(4);
  for (int i = 0; i < 3000; ++i) {
    const Vector p = random_point(random, i % 2 ? 0.5 : 0.02);
    const double known = distance(box, p).m - 0.001;
    if (known > 0) CHECK(distance(convex, p).m == Approx(known).margin(1e-4));
  }
}

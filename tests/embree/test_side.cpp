// test_side.cpp  Inside and outside, at faces, edges, corners and borders.
#include "tests/embree/surface_scenes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

constexpr double kRadius = 0.001;

// Whether the only contact of a small ball says that its middle is inside.
bool says_inside(SurfaceContacts& contacts, const Vector& at) {
  const std::vector<ContactHit> hits = found(contacts, ball_probe(at, kRadius));
  return !hits.empty() && hits[0].gap_m < -kRadius * (1 + 1e-6);
}

}  // namespace

TEST_CASE("inside_is_told_right_near_edges_and_corners_of_a_box") {
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(box({1, 2, 3}), &id, {.reach_m = 0.5f});
  std::mt19937 engine(3);
  for (int i = 0; i < 3000; ++i) {
    // About corners, about edges, about faces; some exactly on a plane that holds a face.
    const Vector small = random_vector(engine, 0.2);
    Vector at = {1, 2, 3};
    if (i % 3 > 0) at[0] = random_vector(engine, 0.9)[0];
    if (i % 3 > 1) at[1] = random_vector(engine, 1.8)[0];
    at = rods::sum(at, small);
    if (i % 5 == 0) at[2] = 3;
    const bool inside = std::fabs(at[0]) < 1 && std::fabs(at[1]) < 2 && std::fabs(at[2]) < 3;
    INFO(at[0] << " " << at[1] << " " << at[2]);
    CHECK(says_inside(contacts, at) == inside);
  }
}

TEST_CASE("inside_is_told_as_by_winding_numbers_on_ridges_and_in_valleys") {
  const MeshData mesh = bumpy_ball(1, 3);
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(mesh, &id, {.reach_m = 2});
  std::mt19937 engine(4);
  uint32_t inside = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector at = random_vector(engine, 1.2);
    if (nearest_of_all(mesh, at).distance_m < 2 * kRadius) continue;
    const bool truth = winds_about(mesh, at);
    inside += truth;
    CHECK(says_inside(contacts, at) == truth);
  }
  CHECK(inside > 500);
}

TEST_CASE("inside_is_told_as_by_winding_numbers_about_spikes_and_sharp_edges") {
  MeshData mesh = ball(1, 2);
  std::mt19937 engine(5);
  for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const double s = 1 + random_vector(engine, 0.7)[0];
    for (size_t k = 0; k < 3; ++k) mesh.places[3 * v + k] *= static_cast<float>(s);
  }
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(mesh, &id, {.reach_m = 2});
  for (int i = 0; i < 20000; ++i) {
    // About corners, and about edges.
    const embree::Triangle t = mesh.triangle(static_cast<size_t>(i) % (mesh.triangles.size() / 3));
    const Vector on = rods::between(t.corners[0], t.corners[1], i % 2 == 0 ? 0 : 0.5);
    const Vector at = rods::sum(on, random_vector(engine, 0.05));
    if (nearest_of_all(mesh, at).distance_m < 2 * kRadius) continue;
    CHECK(says_inside(contacts, at) == winds_about(mesh, at));
  }
}

TEST_CASE("beyond_the_border_of_an_open_surface_all_is_outside") {
  MeshData sheet;
  for (const Vector& p : {Vector{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {1, 0, 1}}) sheet.add_vertex(p);
  sheet.triangles = {0, 2, 1, 1, 2, 3};  // up
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(sheet, &id);
  CHECK(says_inside(contacts, {0.2, -0.01, 0.1}));
  CHECK(says_inside(contacts, {0, -0.01, 0}));  // below the edge that both share
  CHECK_FALSE(says_inside(contacts, {1.01, -0.01, 0}));
  CHECK_FALSE(says_inside(contacts, {1.01, -0.01, 1.01}));
  SurfaceContacts both = contacts_of(sheet, &id, {}, true);
  CHECK_FALSE(says_inside(both, {0.2, -0.01, 0.1}));
}

// test_topology.cpp  Seams are welded, edges find their neighbours, what has no area is left out.
#include "adapters/embree/topology.hpp"
#include "tests/embree/surface_scenes.hpp"

using namespace sinew;
using namespace sinew::test;

TEST_CASE("triangles_without_area_are_left_out_and_counted") {
  MeshData mesh = box({1, 1, 1});
  mesh.add_vertex({0.5, -1, -1});  // between vertices 0 and 1
  for (const uint32_t v : {0u, 0u, 1u, 0u, 8u, 1u}) mesh.triangles.push_back(v);
  const embree::Topology t = embree::connect(mesh.triangles, mesh.places);
  CHECK(t.skipped == 2);
  CHECK(t.triangles.size() == 12);
  CHECK(t.border_edges == 0);
}

TEST_CASE("a_mesh_that_is_split_along_its_edges_is_closed_where_places_agree") {
  const MeshData whole = bumpy_ball(1, 3);
  MeshData split;
  for (const uint32_t v : whole.triangles) {
    split.triangles.push_back(split.vertex_count());
    split.add_vertex(whole.place(v));
  }
  const embree::Topology a = embree::connect(whole.triangles, whole.places);
  const embree::Topology b = embree::connect(split.triangles, split.places);
  CHECK(a.border_edges == 0);
  CHECK(b.border_edges == 0);
  CHECK(a.across == b.across);
}

TEST_CASE("a_hole_has_a_border_and_so_has_a_triangle_turned_round") {
  MeshData mesh = ball(1, 2);
  mesh.triangles.resize(mesh.triangles.size() - 3);
  CHECK(embree::connect(mesh.triangles, mesh.places).border_edges == 3);
  MeshData turned_round = ball(1, 2);
  std::swap(turned_round.triangles[0], turned_round.triangles[1]);
  CHECK(embree::connect(turned_round.triangles, turned_round.places).border_edges == 3);
}

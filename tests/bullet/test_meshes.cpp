// test_meshes.cpp  Triangle meshes and heightfields.
#include "tests/bullet/probes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

// A floor of n x n squares of two triangles, a metre each, from the origin on.
std::vector<btVector3> floor_of(int n) {
  std::vector<btVector3> out;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const float x = static_cast<float>(i), z = static_cast<float>(k);
      for (const btVector3& p : {btVector3(x, 0, z), btVector3(x, 0, z + 1), btVector3(x + 1, 0, z),
                                 btVector3(x + 1, 0, z), btVector3(x, 0, z + 1), btVector3(x + 1, 0, z + 1)})
        out.push_back(p);
    }
  }
  return out;
}

btBvhTriangleMeshShape* mesh_shape(BulletWorld& world, const std::vector<btVector3>& corners) {
  auto* shape = world.shape<btBvhTriangleMeshShape>(world.mesh(corners), true);
  shape->setMargin(0);
  return shape;
}

}  // namespace

TEST_CASE("degenerate_triangles_are_left_out_counted_and_named_once") {
  BulletWorld world;
  std::vector<btVector3> corners = floor_of(1);
  for (const float x : {0.2f, 0.5f, 0.8f}) corners.push_back({x, 0.01f, 0.5f});
  world.body(mesh_shape(world, corners));
  BulletContacts contacts = contacts_of(world);
  for (int i = 0; i < 3; ++i)
    check_hit(deepest(find(contacts, {ball({0.5, 0.1, 0.45}, 0.1f)})), 0, {0, 1, 0});
  const BulletReport report = contacts.report();
  CHECK(report.counts[static_cast<uint32_t>(BulletProblem::kDegenerateTriangle)] >= 1);
  CHECK(report.named == 1);
  CHECK_THAT(contacts.problem(0).message, Catch::Contains("body 0") && Catch::Contains("triangle"));
}

TEST_CASE("a_probe_over_a_mesh_has_its_gap_with_the_margin_on_both_sides") {
  BulletWorld world;
  auto* shape = mesh_shape(world, floor_of(4));
  world.body(shape);
  check_hit(deepest(find(world, ball({1.3, 0.11, 1.2}, 0.1f))), 0.01, {0, 1, 0});
  check_hit(deepest(find(world, ball({1.3, 0.05, 1.2}, 0.1f))), -0.05, {0, 1, 0});
  check_hit(deepest(find(world, ball({1.3, -0.11, 1.2}, 0.1f))), 0.01, {0, -1, 0});
  check_hit(deepest(find(world, ball({-0.08, 0.06, 1.2}, 0.1f))), 0, {-0.8, 0.6, 0});
  shape->setMargin(0.03f);
  check_hit(deepest(find(world, ball({1.3, 0.11, 1.2}, 0.1f))), -0.02, {0, 1, 0});
}

TEST_CASE("a_segment_that_lies_across_many_triangles_touches_at_its_ends_alone") {
  BulletWorld world;
  world.body(mesh_shape(world, floor_of(6)));
  const std::vector<ContactHit> hits = find(world, probe({0.7, 0.1, 0.9}, {5.2, 0.1, 4.3}, 0.1f));
  REQUIRE(hits.size() == 2);
  for (const ContactHit& hit : hits) {
    check_hit(hit, 0, {0, 1, 0});
    CHECK(std::fabs(hit.along) == Approx(1).margin(1e-6));
  }
}

TEST_CASE("inner_edges_of_a_flat_mesh_never_push_sideways") {
  BulletWorld world;
  world.body(mesh_shape(world, floor_of(6)));
  BulletContacts contacts = contacts_of(world);
  for (int i = 0; i < 500; ++i) {
    const double x = 1 + 0.0071 * i, z = 1.1 + 0.0043 * i;
    for (const ContactHit& hit : find(contacts, {probe({x, 0.098, z}, {x + 0.31, 0.101, z + 0.17}, 0.1f),
                                                 ball({x, 0.098, z}, 0.1f)})) {
      CHECK(static_cast<double>(hit.normal[1]) == Approx(1).margin(1e-6));
    }
  }
}

TEST_CASE("a_segment_through_a_sheet_is_pushed_to_the_side_of_its_middle") {
  BulletWorld world;
  world.body(mesh_shape(world, floor_of(4)));
  const ContactHit hit = deepest(find(world, probe({1.6, 0.3, 1.1}, {1.7, -0.1, 1.2}, 0.05f)));
  CHECK(hit.along == 1);
  check_hit(hit, -0.15, {0, 1, 0});
}

TEST_CASE("a_ridge_s_edge_carries_what_lies_across_it") {
  BulletWorld world;
  world.body(mesh_shape(world, {{-1, -1, -1}, {0, 0, 1}, {0, 0, -1}, {1, -1, -1}, {0, 0, -1}, {0, 0, 1}}));
  const std::vector<ContactHit> hits = find(world, probe({-0.5, 0.1, 0.1}, {0.5, 0.1, 0.1}, 0.1f));
  REQUIRE(hits.size() == 1);
  check_hit(hits[0], 0, {0, 1, 0}, 1e-4);
  CHECK(hits[0].along == Approx(0).margin(0.05));
}

TEST_CASE("a_probe_over_or_under_a_heightfield_is_pushed_up") {
  BulletWorld world;
  std::vector<float> heights(11 * 11, 0.0f);
  for (int k = 0; k < 11; ++k)
    for (int i = 6; i < 11; ++i) heights[static_cast<size_t>(11 * k + i)] = 0.5f * static_cast<float>(i - 5);
  auto* field = world.shape<btHeightfieldTerrainShape>(11, 11, heights.data(), 0.0f, 2.5f, 1, false);
  field->setMargin(0);
  world.body(field, btVector3(0, 1.25f, 0));  // Bullet has a heightfield's middle at half its height
  check_hit(deepest(find(world, ball({-2.3, 0.11, 0.4}, 0.1f))), 0.01, {0, 1, 0}, 1e-6);
  check_hit(deepest(find(world, ball({-2.3, -0.04, 0.4}, 0.1f))), -0.14, {0, 1, 0}, 1e-6);
  const double n = std::sqrt(1.25);  // a slope of one to two
  check_hit(deepest(find(world, ball({2 - 0.055 / n, 1 + 0.11 / n, 0.4}, 0.1f))), 0.01, {-0.5 / n, 1 / n, 0},
            1e-6);
}

TEST_CASE("scaled_meshes_are_found_at_their_scale") {
  BulletWorld world;
  auto* scaled =
      world.shape<btScaledBvhTriangleMeshShape>(mesh_shape(world, floor_of(4)), btVector3(2, 1, 2));
  world.body(scaled);
  check_hit(deepest(find(world, ball({7.1, 0.11, 6.4}, 0.1f))), 0.01, {0, 1, 0});
}

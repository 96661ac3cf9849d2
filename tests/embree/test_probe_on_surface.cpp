// test_probe_on_surface.cpp  Contacts of capsules with boxes, balls and ridges, at rest and on their way.
#include <algorithm>

#include "tests/embree/surface_scenes.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

constexpr double kRadius_m = 0.05;
constexpr double kDeeper_m = 0.011 * kRadius_m;  // what a touch is deeper than those beside it, and rounding

Vector unit(const Vector& v) { return rods::scaled(1 / rods::length(v), v); }

double deepest(const std::vector<ContactHit>& hits) {
  double least = 1e30;
  for (const ContactHit& hit : hits) least = std::min(least, hit.gap_m);
  return least;
}

// A capsule that nearly touches a ball of 1 m with its middle, aslant, and would fall and turn.
ContactProbe falling_on_ball(std::mt19937& engine) {
  std::uniform_real_distribution<double> any(-1, 1);
  const Vector out = unit(random_vector(engine, 1)),
               across = unit(rods::cross(out, random_vector(engine, 1)));
  const Vector middle = rods::scaled(1 + kRadius_m * (1.1 + 0.1 * any(engine)), out);
  const Vector half = rods::scaled_sum(0.01 * any(engine), out, rods::scaled(0.2, across));
  ContactProbe falling = probe(rods::difference(middle, half), rods::sum(middle, half), kRadius_m);
  const double falls[2] = {0.05 + 0.05 * any(engine), 0.05 + 0.05 * any(engine)};
  for (size_t e = 0; e < 2; ++e)
    for (size_t k = 0; k < 3; ++k) falling.end_m[e][k] -= falls[e] * out[k];
  return falling;
}

// How far the ball is above the line between contacts, seen from the axis.
double highest_above_told(std::vector<ContactHit> hits, const ContactProbe& p) {
  std::ranges::sort(hits, {}, &ContactHit::along);
  double highest = 0;
  for (size_t h = 0; h + 1 < hits.size(); ++h) {
    for (double share = 0; share <= 1; share += 0.125) {
      const double along = 0.5 + 0.5 * std::lerp(double{hits[h].along}, double{hits[h + 1].along}, share);
      Vector point;
      for (size_t k = 0; k < 3; ++k) point[k] = std::lerp(p.start_m[0][k], p.start_m[1][k], along);
      const double gap = rods::length(point) - 1 - kRadius_m;
      highest = std::max(highest, std::lerp(hits[h].gap_m, hits[h + 1].gap_m, share) - gap);
    }
  }
  return highest;
}

}  // namespace

TEST_CASE("a_ball_touches_a_ball_where_analysis_says") {
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(ball(1, 5), &id, {.reach_m = 0.3f});
  std::mt19937 engine(5);
  for (int i = 0; i < 1000; ++i) {
    Vector out = random_vector(engine, 1);
    out = rods::scaled(1 / rods::length(out), out);
    const double at = 0.8 + 0.4 * i / 1000.0;
    const std::vector<ContactHit> hits = found(contacts, ball_probe(rods::scaled(at, out), 0.05));
    const double gap = at - 1.05;
    if (gap > 0.05 * 0.25 + 1e-3) {
      CHECK(hits.empty());
    } else if (gap < 0.05 * 0.25 - 1e-3) {
      REQUIRE(hits.size() == 1);
      CHECK(hits[0].gap_m == Approx(gap).margin(1e-3));  // facets of 4,096: 0.0012 below the ball
      CHECK(rods::dot(normal_of(hits[0]), out) > 0.99);
    }
  }
}

TEST_CASE("a_capsule_on_a_box_is_held_at_both_ends_on_a_face_and_in_between_on_an_edge") {
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(box({1, 1, 1}), &id);
  const std::vector<ContactHit> lies = found(contacts, probe({-0.3, 1.099, 0.1}, {0.3, 1.099, 0.2}, 0.1));
  REQUIRE(lies.size() == 2);
  for (const ContactHit& hit : lies) {
    CHECK(hit.gap_m == Approx(-0.001));
    CHECK(hit.normal[1] == Approx(1));
    CHECK(std::fabs(hit.along) == 1);
  }
  // Across an edge at 45 degrees: the edge is 0.09 below a point a tenth off its middle.
  const double s = std::sqrt(0.5);
  const Vector middle = {1 + 0.09 * s - 0.1 * s, 1 + 0.09 * s + 0.1 * s, 0}, half = {s, -s, 0};
  const std::vector<ContactHit> edge =
      found(contacts, probe(rods::difference(middle, half), rods::sum(middle, half), 0.1));
  REQUIRE(edge.size() == 1);
  CHECK(edge[0].along == Approx(0.1).margin(1e-6));
  CHECK(edge[0].gap_m == Approx(-0.01));
  CHECK(edge[0].normal[0] == Approx(s));
}

TEST_CASE("the_deepest_contact_is_as_deep_as_brute_force_finds") {
  const MeshData mesh = bumpy_ball(1, 3);
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(mesh, &id);
  std::mt19937 engine(6);
  uint32_t touching = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector from = random_vector(engine, 1.2), to = rods::sum(from, random_vector(engine, 0.2));
    embree::AxisOnTriangle best = {.along = 0, .on = {}, .distance_m = 1e30};
    for (size_t k = 0; k < mesh.triangles.size() / 3; ++k) {
      const embree::AxisOnTriangle n = embree::nearest(mesh.triangle(k), rods::Axis{from, to});
      if (n.distance_m < best.distance_m) best = n;
    }
    const bool outside = !winds_about(mesh, from) && !winds_about(mesh, to) && best.distance_m > 1e-6;
    if (!outside) continue;
    const std::vector<ContactHit> hits = found(contacts, probe(from, to, 0.05));
    if (best.distance_m >= 0.05 * 1.25) {
      CHECK(hits.empty());
      continue;
    }
    ++touching;
    REQUIRE(!hits.empty());
    CHECK(deepest(hits) >= best.distance_m - 0.05 - 1e-9);
    CHECK(deepest(hits) <= best.distance_m - 0.05 + kDeeper_m);
  }
  CHECK(touching > 200);
}

TEST_CASE("an_axis_that_comes_to_lie_on_a_ball_is_kept_off_between_its_ends_too") {
  // Between two contacts half an axis of 0.4 m apart a ball of 1 m rises above the line between them by
  // 0.1^2 / 2, a tenth of the radius; between the ends by four tenths. Facets of 4,096 are off by 0.0012 m.
  const double most_m = 0.1 * 0.1 / 2 + kDeeper_m + 0.0012;
  for (const float reach_m : {0.3f, 0.01f}) {
    SurfaceId id;
    SurfaceContacts contacts = contacts_of(ball(1, 5), &id, {.reach_m = reach_m});
    std::mt19937 engine(10);
    uint32_t lying = 0;
    for (int i = 0; i < 1000; ++i) {
      const ContactProbe falling = falling_on_ball(engine);
      const std::vector<ContactHit> hits = found(contacts, falling);
      lying += hits.size() > 1 && hits[0].along == -1 && hits[1].along == 1;
      CHECK(highest_above_told(hits, falling) < most_m);
    }
    CHECK(lying > 200);
  }
}

TEST_CASE("a_capsule_that_slides_into_a_corner_is_held_by_floor_and_wall") {
  MeshData corner;
  for (const Vector& p : {Vector{-1, 0, -1}, {-1, 0, 1}, {0, 0, -1}, {0, 0, 1}, {0, 1, -1}, {0, 1, 1}}) {
    corner.add_vertex(p);
  }
  corner.triangles = {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4};
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(corner, &id);
  // Along the corner, 0.25 away from the wall; falls by 0.02 and slides by 0.4.
  const double low = 1.1 * kRadius_m;
  const ContactProbe slides = probe({-0.35, low, -0.2}, {-0.35, low, 0.2}, kRadius_m, {0.4, -0.02, 0});
  const std::vector<ContactHit> hits = found(contacts, slides);
  REQUIRE(hits.size() == 4);
  for (const ContactHit& hit : hits) {
    const bool floor = hit.normal[1] == Approx(1);
    CHECK((floor || hit.normal[0] == Approx(-1)));
    CHECK(hit.gap_m == Approx(floor ? 0.1 * kRadius_m : 0.35 - kRadius_m));
    CHECK(std::fabs(hit.along) == 1);
    for (const ContactHit& other : hits) CHECK((&hit == &other || hit.name != other.name));
  }
}

TEST_CASE("what_touches_next_to_an_end_is_told_only_where_it_is_deeper_than_the_end") {
  MeshData roof;  // flat, its ridge along z
  for (const Vector& p :
       {Vector{-1, -0.02, -1}, {-1, -0.02, 1}, {0, 0, -1}, {0, 0, 1}, {1, -0.02, -1}, {1, -0.02, 1}}) {
    roof.add_vertex(p);
  }
  roof.triangles = {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4};
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(roof, &id);
  // Across the ridge at a tenth of the way: 0.4 mm deeper there than at the end beside it, where 0.5 are
  // left, then 0.64.
  const double height = kRadius_m - 0.0004;
  const ContactProbe level = probe({-0.02, height, 0}, {0.2, height, 0}, kRadius_m);
  const std::vector<ContactHit> once = found(contacts, level);
  REQUIRE(once.size() == 2);
  CHECK(once[0].along == -1);
  CHECK(once[1].along == 1);
  const ContactProbe tilted = probe({-0.02, height + 0.0006, 0}, {0.2, height - 0.002, 0}, kRadius_m);
  CHECK(found(contacts, tilted).size() == 3);
}

TEST_CASE("what_is_inside_is_pushed_out_the_shortest_way") {
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(box({1, 1, 1}), &id, {.reach_m = 0.2f});
  const std::vector<ContactHit> hits = found(contacts, probe({0.9, 0.3, 0.1}, {1.3, 0.3, 0.1}, 0.02));
  REQUIRE(hits.size() == 1);
  CHECK(hits[0].gap_m == Approx(-0.12));
  CHECK(hits[0].normal[0] == Approx(1));
  CHECK(hits[0].along == -1);
  CHECK(found(contacts, probe({0.1, 0.3, 0.1}, {0.2, 0.3, 0.1}, 0.02)).empty());  // beyond reach_m
}

TEST_CASE("of_ten_thousand_fast_probes_none_passes_through_a_thin_sheet") {
  const double half = 0.001;  // 2 mm thick
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(box({0.5, half, 0.5}), &id, {.reach_m = 0.0005f});
  std::mt19937 engine(7);
  uint32_t missed = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vector from = rods::sum(random_vector(engine, 0.2), {0, 0.3, 0});
    const Vector to = rods::sum(from, random_vector(engine, 0.05));
    const ContactProbe fast = probe(from, to, 0.002, {0.05, -0.84, 0.02});  // 50 m/s at 60 Hz
    missed += found(contacts, fast).empty();
  }
  CHECK(missed == 0);
}

TEST_CASE("of_ten_thousand_probes_none_is_missed_by_a_surface_at_fifty_metres_a_second") {
  const MeshData there = turned(box({0.5, 0.001, 0.5}), 0, {0, -0.3, 0});
  MeshData gone = turned(there, 0.1, {0, 0.84, 0});
  SurfaceId id;
  SurfaceContacts contacts = contacts_of(there, &id, {.reach_m = 0.0005f});
  REQUIRE(contacts.move_surface(id, {.places_m = gone.places, .dt_s = 1.0f / 60}).ok());
  std::mt19937 engine(8);
  uint32_t missed = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vector from = random_vector(engine, 0.2), to = rods::sum(from, random_vector(engine, 0.05));
    const std::vector<ContactHit> hits = found(contacts, probe(from, to, 0.002));
    missed += hits.empty();
    for (const ContactHit& hit : hits) {
      // The tick closes the gap along the normal that is told.
      const double closes = rods::dot(normal_of(hit), rods::vector_of(hit.velocity_m_s)) / 60;
      CHECK(hit.gap_m - closes < 0.01);
      CHECK(hit.normal[1] > 0.9f);
    }
  }
  CHECK(missed == 0);
}

TEST_CASE("what_moves_with_a_surface_touches_as_on_one_that_stands") {
  const MeshData there = bumpy_ball(0.2, 3);
  const Vector by = {0.4, -0.1, 0.2};
  SurfaceId id, other;
  SurfaceContacts stands = contacts_of(there, &id), moves = contacts_of(there, &other);
  REQUIRE(moves.move_surface(other, {.places_m = turned(there, 0, by).places, .dt_s = 1.0f / 60}).ok());
  std::mt19937 engine(9);
  for (int i = 0; i < 500; ++i) {
    const Vector from = random_vector(engine, 0.25), to = rods::sum(from, random_vector(engine, 0.03));
    const std::vector<ContactHit> a = found(stands, probe(from, to, 0.01)),
                                  b = found(moves, probe(from, to, 0.01, by));
    REQUIRE(a.size() == b.size());
    for (size_t k = 0; k < a.size(); ++k) {
      CHECK(a[k].gap_m == Approx(b[k].gap_m).margin(1e-6));
      CHECK(b[k].velocity_m_s[0] == Approx(60 * by[0]).epsilon(1e-4));
    }
  }
}

TEST_CASE("what_is_left_out_by_groups_or_grows_from_its_root_is_not_pushed") {
  MeshData mesh = box({1, 1, 1});
  std::vector<uint32_t> groups(12, 1u);
  groups[6] = groups[7] = 2;  // the top
  SurfaceContacts contacts;
  REQUIRE(SurfaceContacts::create({.max_owners = 3}, &contacts).ok());
  SurfaceId id;
  REQUIRE(
      contacts.add_surface({.triangles = mesh.triangles, .rest_m = mesh.places, .groups = groups}, &id).ok());
  REQUIRE(contacts.set_filter(1, {.groups = 1}).ok());
  const SurfaceRoot hair = {.surface = id, .place_m = {0.5f, 1, 0}, .radius_m = 0.1f},
                    tail = {.surface = id, .place_m = {1, 0.5f, 0}, .radius_m = 0.1f};
  REQUIRE(contacts.set_filter(2, {.roots = {hair, tail}}).ok());
  ContactProbe top = ball_probe({0.45, 1.04, 0}, 0.05), side = ball_probe({1.04, 0.5, 0}, 0.05);
  CHECK(found(contacts, top).size() == 1);
  top.owner = side.owner = 1;
  CHECK(found(contacts, top).empty());
  CHECK(found(contacts, side).size() == 1);
  // Under the top that is not there, near its rim: not inside any more.
  ContactProbe below = ball_probe({0.97, 0.995, 0.3}, 0.001);
  CHECK(found(contacts, below).size() == 1);
  below.owner = 1;
  below.start_m[0][0] = below.start_m[1][0] = below.end_m[0][0] = below.end_m[1][0] = 1.003;
  below.start_m[0][1] = below.start_m[1][1] = below.end_m[0][1] = below.end_m[1][1] = 1.003;
  CHECK(found(contacts, below).empty());
  top.owner = side.owner = 2;
  CHECK(found(contacts, top).empty());
  CHECK(found(contacts, side).empty());
  CHECK(found(contacts, ball_probe({0.3, 1.04, 0}, 0.05)).size() == 1);
}

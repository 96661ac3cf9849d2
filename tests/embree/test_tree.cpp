// test_tree.cpp  Walks through the tree, on every instruction set, against a look at every triangle.
#include "adapters/embree/tree.hpp"

#include <algorithm>

#include "kernels/kernels.hpp"
#include "tests/embree/surface_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using test::MeshData;

namespace {

constexpr float kRounding_m = 2e-6f;  // of a metre

struct Scene {
  MeshData mesh;
  embree::Topology topology;
  std::vector<float> moves;
  std::vector<uint32_t> groups;
  embree::Tree tree;
  float drift[3] = {0.05f, -0.02f, 0.01f};
};

// The ball's first triangles, about a middle.
Scene scene(uint32_t seed, size_t triangles = SIZE_MAX, const rods::Vector& middle = {}) {
  std::mt19937 random(seed);
  Scene s = {.mesh = test::bumpy_ball(0.2, 3, seed), .topology = {}, .moves = {}, .groups = {}, .tree = {}};
  s.mesh.triangles.resize(3 * std::min(triangles, s.mesh.triangles.size() / 3));
  for (size_t i = 0; i < s.mesh.places.size(); ++i) s.mesh.places[i] += static_cast<float>(middle[i % 3]);
  s.topology = embree::connect(s.mesh.triangles, s.mesh.places);
  for (uint32_t v = 0; v < s.mesh.vertex_count(); ++v) {
    const rods::Vector own = test::random_vector(random, 0.01);
    for (size_t k = 0; k < 3; ++k) s.moves.push_back(s.drift[k] + static_cast<float>(own[k]));
  }
  for (size_t i = 0; i < s.topology.triangles.size(); ++i) s.groups.push_back(1u << random() % 2);
  s.tree.build(s.topology, s.mesh.places, s.groups);
  s.tree.refit(s.topology, s.mesh.places, s.moves, s.drift);
  return s;
}

embree::Triangle triangle_at(const Scene& s, uint32_t i, double share) {
  embree::Triangle out;
  for (size_t c = 0; c < 3; ++c) {
    const uint32_t v = s.topology.triangles[i][c];
    for (size_t k = 0; k < 3; ++k) {
      const double move = static_cast<double>(s.moves[3 * v + k]) - static_cast<double>(s.drift[k]);
      out.corners[c][k] = static_cast<double>(s.mesh.places[3 * v + k]) + share * move;
    }
  }
  return out;
}

// What a walk finds, however often it is taken up.
template <class Step>
std::vector<uint32_t> walked(uint32_t groups, uint32_t leaf, const Step& step) {
  simd::SurfaceWalk walk;
  std::vector<uint32_t> out;
  for (walk.begin(groups, leaf); !walk.done();) {
    step(&walk);
    out.insert(out.end(), walk.found, walk.found + walk.found_count);
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool holds(const std::vector<uint32_t>& sorted, uint32_t i) {
  return std::binary_search(sorted.begin(), sorted.end(), i);
}

simd::SurfacePoint point_at(const rods::Vector& p, float within_m, float rounding_m) {
  return {
      {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}, rounding_m, within_m};
}

// Of all triangles as near to a point as the nearest each is found once, and what is above them is so.
void check_nearest(const Scene& s, const rods::Vector& middle, int points) {
  const auto rounding_m = static_cast<float>(1 + 2 * rods::length(middle)) * kRounding_m;
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    std::mt19937 random(2);
    for (int n = 0; n < points; ++n) {
      // The middle of the ball is as far from many; float holds these places as they are.
      rods::Vector p = rods::sum(middle, n == 0 ? rods::Vector{} : test::random_vector(random, 0.4));
      for (double& x : p) x = static_cast<double>(static_cast<float>(x));
      const uint32_t groups = 1 + n % 3, leaf = n % 2 ? simd::SurfaceWalk::kNoLeaf : 0u;
      double nearest = 1e30;
      for (uint32_t i = 0; i < s.groups.size(); ++i) {
        if (!(s.groups[i] & groups)) continue;
        const embree::OnTriangle on = embree::nearest(triangle_at(s, i, 0), p);
        nearest = std::min(nearest, rods::length(rods::difference(p, on.point)));
      }
      simd::SurfacePoint of = point_at(p, 1, rounding_m);
      const std::vector<uint32_t> found = walked(groups, leaf, [&](simd::SurfaceWalk* walk) {
        kernels.surface_walks->nearest(s.tree.view(), &of, walk);
        for (uint32_t i = 0; i < walk->found_count; ++i) {
          const embree::Triangle t = triangle_at(s, walk->found[i], 0);
          const rods::Vector up = rods::cross(rods::difference(t.corners[1], t.corners[0]),
                                              rods::difference(t.corners[2], t.corners[0]));
          if (walk->above[i]) REQUIRE(rods::dot(up, rods::difference(p, t.corners[0])) > 0);
        }
      });
      REQUIRE(std::adjacent_find(found.begin(), found.end()) == found.end());
      for (uint32_t i = 0; i < s.groups.size(); ++i) {
        const embree::OnTriangle on = embree::nearest(triangle_at(s, i, 0), p);
        const bool is_nearest = rods::length(rods::difference(p, on.point)) <= nearest;
        REQUIRE((holds(found, i) || !is_nearest || !(s.groups[i] & groups)));
      }
    }
  });
}

}  // namespace

TEST_CASE("all_triangles_as_near_to_a_point_as_the_nearest_are_found_once_and_what_is_above_them_is_so") {
  check_nearest(scene(1), {}, 300);
}

TEST_CASE("leaves_and_trees_that_are_not_full_are_walked_whole") {
  for (const size_t triangles : {1, 2, 3, 4, 5, 6, 7, 8, 9, 63, 64, 65})
    check_nearest(scene(1, triangles), {}, 60);
}

TEST_CASE("far_from_their_origin_trees_find_as_much") {
  for (const double far_m : {10.0, 1000.0, 1e5})
    check_nearest(scene(1, SIZE_MAX, {far_m, -far_m, far_m / 3}), {far_m, -far_m, far_m / 3}, 60);
}

TEST_CASE("all_triangles_that_come_near_a_sweep_in_a_share_of_their_way_are_found_and_few_others") {
  const Scene s = scene(3);
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    std::mt19937 random(4);
    size_t told = 0, near = 0;
    for (int n = 0; n < 200; ++n) {
      const rods::Vector on = s.mesh.place(static_cast<uint32_t>(random() % s.mesh.vertex_count()));
      const rods::Vector from = rods::sum(on, test::random_vector(random, 0.02));
      const rods::Vector way = test::random_vector(random, 0.02);
      const rods::Vector arm = n % 5 ? test::random_vector(random, 0.02) : rods::Vector{};
      const double share = n % 3 ? 1 : 0.3, within = 0.004;
      simd::SurfaceSweep sweep;
      sweep.within_m = static_cast<float>(within) + kRounding_m, sweep.share = static_cast<float>(share);
      for (size_t k = 0; k < 3; ++k) {
        sweep.start_m[0][k] = static_cast<float>(from[k]),
        sweep.start_m[1][k] = static_cast<float>(from[k] + arm[k]);
        for (size_t e = 0; e < 2; ++e) sweep.end_m[e][k] = sweep.start_m[e][k] + static_cast<float>(way[k]);
        const auto [low, high] =
            std::minmax({sweep.start_m[0][k], sweep.start_m[1][k], sweep.end_m[0][k], sweep.end_m[1][k]});
        sweep.low_m[k] = low - sweep.within_m, sweep.high_m[k] = high + sweep.within_m;
      }
      const std::vector<uint32_t> found = walked(
          ~0u, simd::SurfaceWalk::kNoLeaf,
          [&](simd::SurfaceWalk* walk) { kernels.surface_walks->near_sweep(s.tree.view(), sweep, walk); });
      told += found.size();
      for (uint32_t i = 0; i < s.groups.size(); ++i) {
        double least = 1e30;
        for (const double time : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
          const rods::Vector at = rods::scaled_sum(time, way, from);
          const embree::AxisOnTriangle on =
              embree::nearest(triangle_at(s, i, share * time), {at, rods::sum(at, arm)});
          least = std::min(least, on.distance_m);
        }
        near += least <= within;
        REQUIRE((holds(found, i) || least > within));
      }
    }
    CHECK(near > 200);
    CHECK(told < 4 * near);
  });
}

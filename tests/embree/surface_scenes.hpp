// surface_scenes.hpp  Closed meshes, probes against them, and the same found by brute force.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "adapters/embree/triangle.hpp"
#include "rods/vector.hpp"
#include "sinew/surface_contacts.hpp"

namespace sinew::test {

using rods::Vector;

struct MeshData {
  std::vector<float> places;
  std::vector<uint32_t> triangles;
  uint32_t vertex_count() const { return static_cast<uint32_t>(places.size() / 3); }
  Vector place(uint32_t v) const { return {places[3 * v], places[3 * v + 1], places[3 * v + 2]}; }
  embree::Triangle triangle(size_t i) const {
    return {{place(triangles[3 * i]), place(triangles[3 * i + 1]), place(triangles[3 * i + 2])}};
  }
  SurfaceDef def() const { return {.triangles = triangles, .rest_m = places}; }
  void add_vertex(const Vector& p) {
    for (const double x : p) places.push_back(static_cast<float>(x));
  }
};

// Middle in the origin; corners are shared by six faces.
inline MeshData box(const Vector& half_m) {
  MeshData out;
  for (uint32_t i = 0; i < 8; ++i) {
    out.add_vertex(
        {(i & 1 ? 1 : -1) * half_m[0], (i & 2 ? 1 : -1) * half_m[1], (i & 4 ? 1 : -1) * half_m[2]});
  }
  out.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                   2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return out;
}

// An octahedron, each triangle cut in four so many times, on a ball.
inline MeshData ball(double radius_m, int cuts) {
  MeshData out;
  for (const Vector& p : {Vector{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    out.add_vertex(rods::scaled(radius_m, p));
  }
  out.triangles = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [found, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, out.vertex_count());
      if (is_new) {
        const Vector m = rods::sum(out.place(a), out.place(b));
        out.add_vertex(rods::scaled(radius_m / rods::length(m), m));
      }
      return found->second;
    };
    std::vector<uint32_t> finer;
    for (size_t i = 0; i < out.triangles.size(); i += 3) {
      const uint32_t a = out.triangles[i], b = out.triangles[i + 1], c = out.triangles[i + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(v);
    }
    out.triangles = finer;
  }
  return out;
}

// A ball whose radius goes up and down by a third: valleys and ridges, still closed.
inline MeshData bumpy_ball(double radius_m, int cuts, double phase = 0) {
  MeshData out = ball(radius_m, cuts);
  for (uint32_t v = 0; v < out.vertex_count(); ++v) {
    const Vector p = rods::scaled(1 / radius_m, out.place(v));
    const double s =
        1 + 0.3 * std::sin(5 * p[0] + phase) * std::cos(4 * p[1] - phase) * std::sin(3 * p[2] + 1);
    for (size_t k = 0; k < 3; ++k) out.places[3 * v + k] = static_cast<float>(s * radius_m * p[k]);
  }
  return out;
}

inline MeshData turned(MeshData mesh, double angle_rad, const Vector& by_m = {}) {
  for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vector p = mesh.place(v);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const Vector q = {c * p[0] + s * p[2] + by_m[0], p[1] + by_m[1], -s * p[0] + c * p[2] + by_m[2]};
    for (size_t k = 0; k < 3; ++k) mesh.places[3 * v + k] = static_cast<float>(q[k]);
  }
  return mesh;
}

inline SurfaceContacts contacts_of(const MeshData& mesh, SurfaceId* id, const SurfaceContactsDef& def = {},
                                   bool two_sided = false) {
  SurfaceContacts out;
  REQUIRE(SurfaceContacts::create(def, &out).ok());
  SurfaceDef surface = mesh.def();
  surface.two_sided = two_sided;
  const Status status = out.add_surface(surface, id);
  INFO(status.message);
  REQUIRE(status.ok());
  return out;
}

inline ContactProbe probe(const Vector& from, const Vector& to, double radius_m, const Vector& move = {}) {
  ContactProbe out;
  for (size_t k = 0; k < 3; ++k) {
    out.start_m[0][k] = from[k], out.start_m[1][k] = to[k];
    out.end_m[0][k] = from[k] + move[k], out.end_m[1][k] = to[k] + move[k];
  }
  out.radius_m = static_cast<float>(radius_m);
  return out;
}
inline ContactProbe ball_probe(const Vector& at, double radius_m, const Vector& move = {}) {
  return probe(at, at, radius_m, move);
}

inline std::vector<ContactHit> found(SurfaceContacts& contacts, std::span<const ContactProbe> probes,
                                     float dt_s = 1.0f / 60) {
  std::vector<ContactHit> hits(16 * probes.size());
  const uint32_t count = contacts.find(probes, dt_s, hits);
  REQUIRE(count <= hits.size());
  hits.resize(count);
  return hits;
}
inline std::vector<ContactHit> found(SurfaceContacts& contacts, const ContactProbe& probe,
                                     float dt_s = 1.0f / 60) {
  return found(contacts, std::span(&probe, 1), dt_s);
}

inline Vector normal_of(const ContactHit& hit) { return rods::vector_of(hit.normal); }

// By looking at every triangle.
struct Brute {
  double distance_m = 1e30;
  Vector point = {};
};
inline Brute nearest_of_all(const MeshData& mesh, const Vector& p) {
  Brute best;
  for (size_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    const embree::OnTriangle on = embree::nearest(mesh.triangle(i), p);
    const double d = rods::length(rods::difference(p, on.point));
    if (d < best.distance_m) best = {d, on.point};
  }
  return best;
}

// By how often the surface winds about a point (van Oosterom, Strackee 1983): no normal is asked.
inline bool winds_about(const MeshData& mesh, const Vector& p) {
  double sum = 0;
  for (size_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    Vector c[3];
    double l[3];
    for (size_t k = 0; k < 3; ++k) {
      c[k] = rods::difference(mesh.triangle(i).corners[k], p);
      l[k] = rods::length(c[k]);
    }
    sum += std::atan2(rods::dot(c[0], rods::cross(c[1], c[2])),
                      l[0] * l[1] * l[2] + rods::dot(c[0], c[1]) * l[2] + rods::dot(c[1], c[2]) * l[0] +
                          rods::dot(c[2], c[0]) * l[1]);
  }
  return sum > 3.14159;  // 2 pi inside, 0 outside
}

inline Vector random_vector(std::mt19937& engine, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  return {u(engine), u(engine), u(engine)};
}

}  // namespace sinew::test

// remesh.cpp  Isotropic remeshing on an implicit surface.
#include "baker/creature/remesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sinew::baker {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

class Remesher {
 public:
  Remesher(const BodyField& field, Surface surface) : field_(field) {
    positions_ = std::move(surface.positions);
    triangles_ = std::move(surface.triangles);
    faces_.resize(positions_.size());
    for (size_t t = 0; t < triangles_.size(); ++t)
      for (int v : triangles_[t]) faces_of(v).push_back(static_cast<int>(t));
    edge_scale_.resize(positions_.size());
    for (size_t v = 0; v < positions_.size(); ++v) edge_scale_[v] = field_.sample(positions_[v]).edge_scale;
    vertices_ = positions_.size();
  }

  void pass(double edge_m) {
    edge_m_ = edge_m;
    smooth_scale();
    split_long_edges();
    collapse_short_edges();
    flip_edges();
    for (int i = 0; i < 3; ++i) relax();
  }

  size_t vertices() const { return vertices_; }

  // Edge length at which equilateral triangles would cover the surface with this many vertices.
  double edge_for(size_t vertices) const {
    double cover = 0;
    for (const Triangle& t : triangles_) {
      if (t[0] < 0) continue;
      const double scale = (scale_at(t[0]) + scale_at(t[1]) + scale_at(t[2])) / 3;
      cover += 0.5 * area_vector(t).norm() / (scale * scale);
    }
    return std::sqrt(cover / (std::sqrt(3.0) / 2 * static_cast<double>(vertices)));
  }

  Surface take() const {
    Surface out;
    std::vector<int> renumbered(positions_.size(), -1);
    for (const Triangle& t : triangles_) {
      if (t[0] < 0) continue;
      Triangle kept;
      for (size_t i = 0; i < 3; ++i) {
        int& number = renumbered[static_cast<size_t>(t[i])];
        if (number < 0) {
          number = static_cast<int>(out.positions.size());
          out.positions.push_back(at(t[i]));
        }
        kept[i] = number;
      }
      out.triangles.push_back(kept);
    }
    return out;
  }

 private:
  Vector3d& at(int v) { return positions_[static_cast<size_t>(v)]; }
  const Vector3d& at(int v) const { return positions_[static_cast<size_t>(v)]; }
  std::vector<int>& faces_of(int v) { return faces_[static_cast<size_t>(v)]; }
  const std::vector<int>& faces_of(int v) const { return faces_[static_cast<size_t>(v)]; }
  Triangle& triangle(int t) { return triangles_[static_cast<size_t>(t)]; }
  const Triangle& triangle(int t) const { return triangles_[static_cast<size_t>(t)]; }
  double scale_at(int v) const { return edge_scale_[static_cast<size_t>(v)]; }

  Vector3d area_vector(const Triangle& t) const { return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])); }
  double length(int a, int b) const { return (at(a) - at(b)).norm(); }
  double wanted(int a, int b) const { return edge_m_ * 0.5 * (scale_at(a) + scale_at(b)); }

  std::vector<int> neighbours(int v) const {
    std::vector<int> found;
    for (int t : faces_of(v))
      for (int other : triangle(t))
        if (other != v) found.push_back(other);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  // The triangle that runs a -> b and its third corner.
  std::pair<int, int> left_of(int a, int b) const {
    for (int t : faces_of(a))
      for (size_t i = 0; i < 3; ++i)
        if (triangle(t)[i] == a && triangle(t)[(i + 1) % 3] == b) return {t, triangle(t)[(i + 2) % 3]};
    return {-1, -1};
  }

  void replace_corner(int t, int from, int to) {
    for (int& v : triangle(t))
      if (v == from) v = to;
  }
  void forget_face(int v, int t) { std::erase(faces_of(v), t); }

  void smooth_scale() {
    const std::vector<double> before = edge_scale_;
    for (size_t v = 0; v < positions_.size(); ++v) {
      if (faces_[v].empty()) continue;
      double sum = 2 * before[v], count = 2;
      for (int n : neighbours(static_cast<int>(v))) sum += before[static_cast<size_t>(n)], ++count;
      edge_scale_[v] = sum / count;
    }
  }

  void split_long_edges() {
    constexpr int kRounds = 3;  // bounded: slivers could be split for ever
    for (int round = 0; round < kRounds; ++round) {
      const int count = static_cast<int>(triangles_.size());
      for (int t = 0; t < count; ++t)
        if (triangle(t)[0] >= 0) split_longest_edge(t);
    }
  }

  void split_longest_edge(int t) {
    constexpr double kTooLong = 4.0 / 3;
    const Triangle corners = triangle(t);
    double longest = kTooLong;
    std::pair<int, int> edge = {-1, -1};
    for (size_t i = 0; i < 3; ++i) {
      const int a = corners[i], b = corners[(i + 1) % 3];
      const double ratio = length(a, b) / wanted(a, b);
      if (ratio > longest) longest = ratio, edge = {a, b};
    }
    if (edge.first >= 0) split(edge.first, edge.second);
  }

  void split(int a, int b) {
    const auto [left, c] = left_of(a, b);
    const auto [right, d] = left_of(b, a);
    const int middle = static_cast<int>(positions_.size());
    positions_.push_back(0.5 * (at(a) + at(b)));
    edge_scale_.push_back(field_.sample(positions_.back()).edge_scale);
    faces_.emplace_back();
    ++vertices_;
    split_face(left, b, middle, c, {middle, b, c});
    split_face(right, b, middle, d, {b, middle, d});
  }

  void split_face(int t, int moved, int middle, int opposite, const Triangle& added) {
    const int fresh = static_cast<int>(triangles_.size());
    replace_corner(t, moved, middle);
    forget_face(moved, t);
    triangles_.push_back(added);
    faces_of(middle).push_back(t);
    faces_of(middle).push_back(fresh);
    faces_of(moved).push_back(fresh);
    faces_of(opposite).push_back(fresh);
  }

  void collapse_short_edges() {
    constexpr double kTooShort = 4.0 / 5;
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
      for (size_t i = 0; i < 3 && triangle(t)[0] >= 0; ++i) {
        const int a = triangle(t)[i], b = triangle(t)[(i + 1) % 3];
        if (length(a, b) < kTooShort * wanted(a, b)) collapse(a, b);
      }
  }

  void collapse(int a, int b) {
    const std::vector<int> around_a = neighbours(a), around_b = neighbours(b);
    std::vector<int> shared;
    std::set_intersection(around_a.begin(), around_a.end(), around_b.begin(), around_b.end(),
                          std::back_inserter(shared));
    if (shared.size() != 2) return;  // the link condition: else a tunnel would close
    for (int v : shared)
      if (faces_of(v).size() <= 3) return;
    const Vector3d place = field_.project(0.5 * (at(a) + at(b)));
    constexpr double kStillShort = 1.3;
    for (const auto& [center, around] : {std::pair{a, &around_a}, std::pair{b, &around_b}})
      for (int v : *around)
        if (v != a && v != b && (at(v) - place).norm() > kStillShort * wanted(center, v)) return;
    if (folds(a, place, b) || folds(b, place, a) || cuts_through(a, place, b) || cuts_through(b, place, a))
      return;
    merge(a, b, place);
  }

  // Whether moving v to `place` turns one of its triangles, other than those it shares with `except`, over or
  // away from the surface.
  bool folds(int v, const Vector3d& place, int except) const {
    constexpr double kMostTurn = 0.35, kMostLean = 0.2;  // cosines
    constexpr double kSliver = 0.1;                      // area
    const Vector3d outward = field_.sample(place).gradient.normalized();
    for (int t : faces_of(v)) {
      const Triangle& corners = triangle(t);
      if (std::find(corners.begin(), corners.end(), except) != corners.end()) continue;
      std::array<Vector3d, 3> corner;
      for (size_t i = 0; i < 3; ++i) corner[i] = corners[i] == v ? place : at(corners[i]);
      const Vector3d after = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
      const Vector3d before = area_vector(corners);
      const bool sliver = before.norm() < kSliver * edge_m_ * edge_m_;  // its normal says nothing
      const double lean = before.normalized().dot(outward);
      if (!sliver && after.dot(before) <= kMostTurn * before.norm()) return true;
      if (after.dot(outward) < (sliver ? kMostLean : std::min(kMostLean, lean))) return true;
    }
    return false;
  }

  // Whether moving v to `place` makes a triangle, other than those it shares with `except`, leave the
  // surface: the start of eating a thin ear away.
  bool cuts_through(int v, const Vector3d& place, int except) const {
    for (int t : faces_of(v)) {
      const Triangle& corners = triangle(t);
      if (std::find(corners.begin(), corners.end(), except) != corners.end()) continue;
      Vector3d center = Vector3d::Zero();
      for (int corner : corners) center += (corner == v ? place : at(corner)) / 3;
      if (strays(center)) return true;
    }
    return false;
  }

  bool strays(const Vector3d& center) const {
    constexpr double kMostOff = 0.2;  // of the edge length
    const FieldSample here = field_.sample(center);
    return std::abs(here.distance) > kMostOff * edge_m_ * here.edge_scale;
  }

  void merge(int a, int b, const Vector3d& place) {
    const std::vector<int> faces_of_b = faces_of(b);
    for (int t : faces_of_b) {
      Triangle& corners = triangle(t);
      if (std::find(corners.begin(), corners.end(), a) != corners.end()) {
        for (int v : Triangle(corners)) forget_face(v, t);
        corners = {-1, -1, -1};
      } else {
        replace_corner(t, b, a);
        faces_of(a).push_back(t);
      }
    }
    faces_of(b).clear();
    at(a) = place;
    --vertices_;
  }

  void flip_edges() {
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
      for (size_t i = 0; i < 3 && triangle(t)[0] >= 0; ++i) {
        const int a = triangle(t)[i], b = triangle(t)[(i + 1) % 3];
        if (a < b) flip_if_better(a, b);
      }
  }

  // Valences come nearer to six, and the two triangles stay on their side of the surface.
  void flip_if_better(int a, int b) {
    const auto [left, c] = left_of(a, b);
    const auto [right, d] = left_of(b, a);
    const auto excess = [&](int v, int change) {
      const int off = static_cast<int>(faces_of(v).size()) + change - 6;
      return off * off;
    };
    const int now = excess(a, 0) + excess(b, 0) + excess(c, 0) + excess(d, 0);
    if (excess(a, -1) + excess(b, -1) + excess(c, 1) + excess(d, 1) >= now) return;
    if (faces_of(a).size() <= 3 || faces_of(b).size() <= 3 || left_of(c, d).first >= 0) return;
    const Triangle first = {a, d, c}, second = {d, b, c};
    const Vector3d old = area_vector(triangle(left)).normalized() + area_vector(triangle(right)).normalized();
    constexpr double kMostTurn = 0.5;
    for (const Triangle& fresh : {first, second}) {
      if (area_vector(fresh).normalized().dot(old.normalized()) < kMostTurn) return;
      if (strays((at(fresh[0]) + at(fresh[1]) + at(fresh[2])) / 3)) return;
    }
    forget_face(b, left);
    forget_face(a, right);
    faces_of(d).push_back(left);
    faces_of(c).push_back(right);
    triangle(left) = first;
    triangle(right) = second;
  }

  void relax() {
    for (int v = 0; v < static_cast<int>(positions_.size()); ++v) {
      if (faces_of(v).empty()) continue;
      const std::vector<int> around = neighbours(v);
      Vector3d center = Vector3d::Zero();
      double weight = 0;
      for (int n : around) {
        const double w = length(v, n) / wanted(v, n);  // longer than wanted pulls more
        center += w * at(n);
        weight += w;
      }
      const Vector3d normal = field_.sample(at(v)).gradient.normalized();
      Vector3d move = center / weight - at(v);
      move -= normal * normal.dot(move);
      const Vector3d place = field_.project(at(v) + 0.6 * move);
      if ((place - at(v)).norm() < edge_m_ && !folds(v, place, -1)) at(v) = place;
    }
  }

  const BodyField& field_;
  std::vector<Vector3d> positions_;
  std::vector<double> edge_scale_;
  std::vector<Triangle> triangles_;      // removed ones hold -1
  std::vector<std::vector<int>> faces_;  // of a vertex; empty when it is removed
  size_t vertices_ = 0;
  double edge_m_ = 0.01;
};

}  // namespace

Surface remesh(const BodyField& field, Surface surface, size_t vertices) {
  constexpr int kFirstPasses = 5, kMostPasses = 16;
  constexpr double kCloseEnough = 0.02;
  Remesher mesh(field, std::move(surface));
  double edge_m = mesh.edge_for(vertices);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    mesh.pass(edge_m);
    const double ratio = static_cast<double>(mesh.vertices()) / static_cast<double>(vertices);
    if (pass + 1 >= kFirstPasses && std::abs(ratio - 1) < kCloseEnough) break;
    if (pass + 1 >= kFirstPasses - 2) edge_m *= std::sqrt(ratio);
  }
  return mesh.take();
}

}  // namespace sinew::baker

// weld.cpp  Welding by place and influences.
#include "baker/import/meshes/weld.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "baker/import/character/smooth_groups.hpp"

namespace sinew::baker {
namespace {

// Of the character's longest side: what conversions between spaces leave of a place that was one.
constexpr double kSamePlace = 1e-6;
// Sum over the joints. Exporters round weights to 8 or 16 bits, and smooth each mesh for itself up to its
// rim.
constexpr double kSameWeights = 0.02;
constexpr double kFlatTriangle = 1e-12;  // doubled area as a share of the longest side squared

double weight_of(const Influences& influences, int joint) {
  for (size_t k = 0; k < kInfluences; ++k)
    if (influences.joint[k] == joint && influences.weight[k] > 0) return influences.weight[k];
  return 0;
}

bool same_influences(const Influences& a, const Influences& b) {
  double apart = 0;
  for (size_t k = 0; k < kInfluences; ++k) {
    if (a.weight[k] > 0) apart += std::abs(a.weight[k] - weight_of(b, a.joint[k]));
    if (b.weight[k] > 0 && !(weight_of(a, b.joint[k]) > 0)) apart += b.weight[k];
  }
  return apart < kSameWeights;
}

// Distinct vertices by place. Cells are many tolerances wide, so that a place seldom reaches into a second
// one; where it does, that is searched too.
class PlacesFound {
 public:
  explicit PlacesFound(const Character& character) : character_(character) {
    Eigen::AlignedBox3d box;
    for (const Vector3& place : character.positions) box.extend(place);
    corner_ = box.isEmpty() ? Vector3::Zero() : box.min();
    tolerance_ = box.isEmpty() ? 0 : kSamePlace * box.sizes().maxCoeff();
    cell_ = tolerance_ > 0 ? kCell * tolerance_ : 1;
  }

  // The first one at the vertex's place that moves as it does; -1: none, it is distinct.
  int first_like(size_t vertex) const {
    int first = -1;
    each_cell(vertex, tolerance_, [&](const Cell& cell) {
      const auto found = distinct_.find(cell);
      if (found == distinct_.end()) return;
      for (const int other : found->second)
        if ((first < 0 || other < first) && are_one(static_cast<size_t>(other), vertex)) first = other;
    });
    return first;
  }

  void add(size_t vertex) {
    each_cell(vertex, 0, [&](const Cell& cell) { distinct_[cell].push_back(static_cast<int>(vertex)); });
  }

 private:
  static constexpr double kCell = 16;  // tolerances
  using Cell = std::array<int64_t, 3>;
  struct CellHash {
    size_t operator()(const Cell& cell) const {
      size_t hash = 0;
      for (const int64_t k : cell) hash = hash * 0x9e3779b97f4a7c15u + std::hash<int64_t>{}(k);
      return hash;
    }
  };

  bool are_one(size_t a, size_t b) const {
    return (character_.positions[a] - character_.positions[b]).norm() <= tolerance_ &&
           same_influences(character_.skin[a], character_.skin[b]);
  }

  template <typename Visit>
  void each_cell(size_t vertex, double reach, const Visit& visit) const {
    const Vector3 at = character_.positions[vertex] - corner_;
    const auto cell_of = [&](double way) { return static_cast<int64_t>(std::floor(way / cell_)); };
    for (int64_t x = cell_of(at.x() - reach); x <= cell_of(at.x() + reach); ++x)
      for (int64_t y = cell_of(at.y() - reach); y <= cell_of(at.y() + reach); ++y)
        for (int64_t z = cell_of(at.z() - reach); z <= cell_of(at.z() + reach); ++z) visit(Cell{x, y, z});
  }

  const Character& character_;
  Vector3 corner_;
  double tolerance_ = 0, cell_ = 1;
  std::unordered_map<Cell, std::vector<int>, CellHash> distinct_;
};

bool degenerate(const Character& character, const std::array<int, 3>& face) {
  const Vector3& a = character.positions[static_cast<size_t>(face[0])];
  const Vector3 ab = character.positions[static_cast<size_t>(face[1])] - a;
  const Vector3 ac = character.positions[static_cast<size_t>(face[2])] - a;
  const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return !(ab.cross(ac).norm() > kFlatTriangle * longest);
}

}  // namespace

void weld_vertices(Character& character) {
  PlacesFound places(character);
  character.welded.resize(character.positions.size());
  for (size_t v = 0; v < character.welded.size(); ++v) {
    const int first = places.first_like(v);
    character.welded[v] = first >= 0 ? first : static_cast<int>(v);
    if (first < 0) places.add(v);
  }
}

void drop_degenerate_triangles(Character& character, Source& source) {
  std::vector<std::array<int, 3>> kept;
  for (PrimitiveSpan& primitive : character.primitives) {
    const std::span faces =
        std::span(character.triangles).subspan(primitive.first_triangle, primitive.triangle_count);
    primitive.first_triangle = kept.size();
    std::ranges::copy_if(faces, std::back_inserter(kept),
                         [&](const auto& face) { return !degenerate(character, face); });
    primitive.triangle_count = kept.size() - primitive.first_triangle;
  }
  const size_t dropped = character.triangles.size() - kept.size();
  character.triangles = std::move(kept);
  if (dropped > 0) source.note("", std::to_string(dropped) + " triangles without area: left out");
}

void compute_missing_normals(Character& character) {
  const std::vector<Vector3> areas = area_vectors(character, smooth_groups(character));
  for (size_t v = 0; v < areas.size(); ++v) {
    if (!character.normals[v].isZero(0)) continue;
    character.normals[v] = areas[v].norm() > 0 ? areas[v].normalized() : Vector3::UnitY();
  }
}

}  // namespace sinew::baker

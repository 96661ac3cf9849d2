// layer_gaps.cpp  Layers found anew from a pack's surface, whatever it was baked with.
#include "baker/audit/layer_gaps.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "baker/import/meshes/weld.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {
namespace {

// Of the reach: layers that the file has closer touch, and have no sides.
constexpr float kTouching = 0.02f;
// Of the gap as bound: what skinning leaves less of, it presses together itself.
constexpr double kKeptApart = 0.5;

Character surface_of(const pack::PackView& view) {
  Character character;
  const size_t count = view.character->vertex_count;
  for (size_t v = 0; v < count; ++v) {
    const auto vector = [&](const auto& values) {
      return Vector3(Eigen::Map<const Eigen::Vector3f>(values.data() + 3 * v).cast<double>());
    };
    character.positions.push_back(vector(view.positions));
    character.normals.push_back(vector(view.normals));
    Influences& skin = character.skin.emplace_back();
    for (size_t k = 0; k < pack::kInfluences; ++k) {
      skin.joint[k] = static_cast<int>(view.skin[v].joint[k]);
      skin.weight[k] = static_cast<double>(view.skin[v].weight[k]);
    }
  }
  for (size_t t = 0; t + 2 < view.triangles.size(); t += 3)
    character.triangles.push_back({static_cast<int>(view.triangles[t]),
                                   static_cast<int>(view.triangles[t + 1]),
                                   static_cast<int>(view.triangles[t + 2])});
  weld_vertices(character);
  return character;
}

}  // namespace

void LayerGap::take(const LayerGap& other) {
  least_m = std::min(least_m, other.least_m);
  largest_m = std::max(largest_m, other.largest_m);
  file_least_m = std::min(file_least_m, other.file_least_m);
  file_largest_m = std::max(file_largest_m, other.file_largest_m);
  crossed_m = std::max(crossed_m, other.crossed_m);
}

LayerGaps::LayerGaps(const pack::PackView& view, const AuditedParts& parts) : parts_(parts.all.size()) {
  if (parts.regions == 0) return;
  const Character character = surface_of(view);
  const double reach_m = usual_layer_m(character);
  const std::vector<bool> any(character.positions.size(), true);  // a layer may be soft over one that is not
  const std::vector<Overlap> overlaps = find_overlaps(character, find_surface(character), any, reach_m);
  Player::Surface bound(3, static_cast<Eigen::Index>(any.size()));
  for (size_t v = 0; v < any.size(); ++v)
    bound.col(static_cast<Eigen::Index>(v)) = character.positions[v].cast<float>();
  const auto region_of = [&](int vertex) {
    const int part = parts.of_vertex[static_cast<size_t>(vertex)];
    return part < static_cast<int>(parts.regions) ? part : AuditedParts::kNone;
  };
  for (size_t v = 0; v < overlaps.size(); ++v) {
    if (overlaps[v].triangle < 0) continue;
    const auto& face = character.triangles[static_cast<size_t>(overlaps[v].triangle)];
    Pair pair{.vertex = static_cast<Eigen::Index>(v)};
    int part = region_of(static_cast<int>(v));
    for (size_t c = 0; c < 3; ++c) {
      pair.beneath[c] = face[c];
      pair.share[c] = static_cast<float>(overlaps[v].share[c]);
      part = std::max(part, region_of(face[c]));
    }
    const float gap = gap_m(pair, bound);
    if (part == AuditedParts::kNone || std::abs(gap) < kTouching * static_cast<float>(reach_m)) continue;
    pair.side = gap < 0 ? -1 : 1;
    pair.bound_m = std::abs(gap);
    pair.part = static_cast<size_t>(part);
    pairs_.push_back(pair);
  }
}

float LayerGaps::gap_m(const Pair& pair, const Player::Surface& surface) {
  const Eigen::Vector3f a = surface.col(pair.beneath[0]), b = surface.col(pair.beneath[1]),
                        c = surface.col(pair.beneath[2]);
  const Eigen::Vector3f place = pair.share[0] * a + pair.share[1] * b + pair.share[2] * c;
  return pair.side * (surface.col(pair.vertex) - place).dot((b - a).cross(c - a).normalized());
}

std::vector<LayerGap> LayerGaps::of(const Player& player) const {
  std::vector<LayerGap> gaps(parts_);
  for (const Pair& pair : pairs_) {
    const double shown = gap_m(pair, player.shown()), skinned = gap_m(pair, player.skinned());
    LayerGap one{shown, shown, skinned, skinned, 0};
    if (skinned > kKeptApart * static_cast<double>(pair.bound_m) && shown < 0) one.crossed_m = -shown;
    gaps[pair.part].take(one);
  }
  return gaps;
}

}  // namespace sinew::baker

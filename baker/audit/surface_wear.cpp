// surface_wear.cpp  Vertices, edges and triangles against the skinned surface.
#include "baker/audit/surface_wear.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "baker/audit/bounds.hpp"

namespace sinew::baker {
namespace {

Eigen::Vector3f normal_of(const Player::Surface& surface, const std::array<uint32_t, 3>& corners) {
  const auto a = surface.col(corners[0]), b = surface.col(corners[1]), c = surface.col(corners[2]);
  return (b - a).cross(c - a);
}

// How rods turn the three corners in the mean: what they turn is not turned over.
Eigen::Matrix3f turn_of(const std::vector<Eigen::Matrix3f>& turns, const pack::PackView& character,
                        const std::array<uint32_t, 3>& corners) {
  Eigen::Matrix3f mean = Eigen::Matrix3f::Zero();
  for (const uint32_t corner : corners) {
    const pack::SkinRecord& skin = character.skin[corner];
    for (size_t k = 0; k < pack::kInfluences && skin.weight[k] > 0; ++k)
      mean += skin.weight[k] * turns[skin.joint[k]];
  }
  return mean;
}

}  // namespace

std::vector<double> displacements_m(const AuditedParts& parts, const pack::PackView& character,
                                    const Player& player) {
  std::vector<double> out(parts.all.size(), 0);
  for (size_t v = 0; v < parts.of_vertex.size(); ++v) {
    const int part = parts.of_vertex[v];
    if (part == AuditedParts::kNone || parts.all[static_cast<size_t>(part)].is_rod) continue;
    const auto at = static_cast<Eigen::Index>(v);
    // What hangs on a rod's bone and is soft beside is counted whole: an engine shows both.
    const double way = (player.shown().col(at) - player.skinned().col(at)).norm();
    out[static_cast<size_t>(part)] = std::max(out[static_cast<size_t>(part)], way);
  }
  for (size_t r = 0; r < character.rods.size(); ++r) {
    const Eigen::Matrix3Xf apart =
        player.rod_ends(character.rods[r], false) - player.rod_ends(character.rods[r], true);
    out[parts.regions + r] = apart.colwise().norm().maxCoeff();
  }
  return out;
}

std::vector<Wear> surface_wear(const AuditedParts& parts, const pack::PackView& character,
                               const Player& player) {
  std::vector<Wear> wear(parts.all.size());
  const std::vector<double> displacements = displacements_m(parts, character, player);
  for (size_t p = 0; p < wear.size(); ++p) wear[p].displacement_m = displacements[p];
  const double shortest = kShortestEdge * static_cast<double>(character.character->height_m);
  for (const AuditedParts::Edge& edge : parts.edges) {
    const double skinned = (player.skinned().col(edge.a) - player.skinned().col(edge.b)).norm();
    if (skinned < shortest) continue;
    const double shown = (player.shown().col(edge.a) - player.shown().col(edge.b)).norm();
    double& most = wear[static_cast<size_t>(edge.part)].edge_stretch;
    most = std::max(most, edge.stretch(skinned, shown));
  }
  std::vector<Eigen::Matrix3f> turns;
  for (uint32_t j = 0; j < character.joints.size(); ++j) turns.push_back(player.turn_of(j));
  for (size_t t = 0; t < parts.triangles.size(); ++t) {
    const auto& corners = parts.triangles[t];
    const Eigen::Vector3f skinned = normal_of(player.skinned(), corners);
    if (skinned.norm() < shortest * shortest) continue;
    const Eigen::Vector3f turned = turn_of(turns, character, corners) * skinned;
    wear[static_cast<size_t>(parts.of_triangle[t])].inverted +=
        turned.dot(normal_of(player.shown(), corners)) < 0;
  }
  return wear;
}

}  // namespace sinew::baker

// weld.cpp  Welding by place and influences.
#include "baker/import/weld.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "baker/import/smooth_groups.hpp"

namespace sinew::baker {
namespace {

constexpr double kSameWeight = 1e-3;     // exporters round weights to 8 or 16 bits
constexpr double kFlatTriangle = 1e-12;  // doubled area as a share of the longest side squared

struct PlaceHash {
  size_t operator()(const Vector3& place) const {
    size_t hash = 0;
    for (Eigen::Index k = 0; k < 3; ++k) hash = hash * 0x9e3779b97f4a7c15u + std::hash<double>{}(place[k]);
    return hash;
  }
};

double weight_of(const Influences& influences, int joint) {
  for (size_t k = 0; k < kInfluences; ++k)
    if (influences.joint[k] == joint && influences.weight[k] > 0) return influences.weight[k];
  return 0;
}

bool same_influences(const Influences& a, const Influences& b) {
  for (size_t k = 0; k < kInfluences; ++k)
    if (std::abs(weight_of(b, a.joint[k]) - weight_of(a, a.joint[k])) > kSameWeight ||
        std::abs(weight_of(a, b.joint[k]) - weight_of(b, b.joint[k])) > kSameWeight)
      return false;
  return true;
}

bool degenerate(const Character& character, const std::array<int, 3>& face) {
  const Vector3& a = character.positions[static_cast<size_t>(face[0])];
  const Vector3 ab = character.positions[static_cast<size_t>(face[1])] - a;
  const Vector3 ac = character.positions[static_cast<size_t>(face[2])] - a;
  const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return !(ab.cross(ac).norm() > kFlatTriangle * longest);
}

}  // namespace

void weld_vertices(Character& character) {
  const size_t count = character.positions.size();
  std::unordered_map<Vector3, int, PlaceHash> newest;  // place -> newest distinct vertex there
  std::vector<int> before(count, -1);  // the distinct vertex at the same place before this one
  character.welded.resize(count);
  for (size_t v = 0; v < count; ++v) {
    const Vector3 place = character.positions[v] + Vector3::Zero();  // -0 and 0 are one place
    const auto [found, fresh] = newest.try_emplace(place, static_cast<int>(v));
    int other = fresh ? -1 : found->second;
    while (other >= 0 && !same_influences(character.skin[static_cast<size_t>(other)], character.skin[v]))
      other = before[static_cast<size_t>(other)];
    character.welded[v] = other >= 0 ? other : static_cast<int>(v);
    if (other >= 0 || fresh) continue;
    before[v] = found->second;
    found->second = static_cast<int>(v);
  }
}

void drop_degenerate_triangles(Character& character, Source& source) {
  const size_t dropped =
      std::erase_if(character.triangles, [&](const auto& face) { return degenerate(character, face); });
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

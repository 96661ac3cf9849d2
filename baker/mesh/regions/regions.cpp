// regions.cpp  Soft parts, their frames and names.
#include "baker/mesh/regions/regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/recipe/region_scope.hpp"
#include "baker/mesh/regions/layers.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kFewestVertices = 4;  // fewer have no inside and no volume to speak of
constexpr double kIslet = 0.25;        // of the extent of its region's largest part

std::vector<double> weight_a_joint(const Character& character, const std::vector<int>& vertices,
                                   const std::vector<double>& share) {
  std::vector<double> sum(character.joint_node.size(), 0);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Influences& skin = character.skin[static_cast<size_t>(vertices[i])];
    for (size_t k = 0; k < kInfluences; ++k)
      sum[static_cast<size_t>(skin.joint[k])] += share[i] * skin.weight[k];
  }
  return sum;
}

int largest(const std::vector<double>& values) {
  return static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
}

struct Piece {
  size_t vertices = 0;
  int region = -1;
  Eigen::AlignedBox3d box = {};
};

std::vector<Piece> pieces_of(const Character& character, const Surface& surface, const std::vector<int>& part,
                             const std::vector<int>& region) {
  std::vector<Piece> pieces;
  for (size_t v = 0; v < part.size(); ++v) {
    if (part[v] < 0 || surface.lies(v)) continue;
    pieces.resize(std::max(pieces.size(), static_cast<size_t>(part[v]) + 1));
    Piece& piece = pieces[static_cast<size_t>(part[v])];
    ++piece.vertices;
    piece.box.extend(character.positions[v]);
    piece.region = region[v];
  }
  return pieces;
}

// Of each joint, where the part is soft.
std::vector<double> soft_weight(const Character& character, const std::vector<double>& stiffness,
                                const std::vector<int>& vertices) {
  std::vector<double> softness;
  for (int v : vertices) softness.push_back(1 - stiffness[static_cast<size_t>(v)]);
  return weight_a_joint(character, vertices, softness);
}

}  // namespace

SoftKind kind_of_region(const std::string& name, const RegionRecipe* stated) {
  if (stated && stated->kind) return *stated->kind;
  if (const auto kind = meaning_of(name).kind) return *kind;
  // An artist who calls a region thigh_l means its flesh, where a bone of that name is a limb.
  if (const auto kind = kind_called(name.substr(0, name.find('_')))) return *kind;
  if (stated)
    for (const std::string& joint : stated->joints)
      if (const auto kind = meaning_of(joint).kind) return *kind;
  if (stated)
    for (const std::string& piece : {stated->mesh, stated->material})
      if (const auto kind = meaning_of(piece).kind) return *kind;
  return SoftKind::kOther;
}

SoftParts find_soft_parts(Character& character, const Surface& surface, double rigid_stiffness,
                          Stiffness& stiffness) {
  std::vector<bool> soft(stiffness.of_vertex.size());
  for (size_t v = 0; v < soft.size(); ++v) soft[v] = stiffness.of_vertex[v] < rigid_stiffness;
  SoftParts found{layered_parts(surface, soft), {}, 0};
  const std::vector<Piece> pieces = pieces_of(character, surface, found.part, stiffness.region);
  std::map<int, double> largest_of;
  for (const Piece& piece : pieces)
    largest_of[piece.region] = std::max(largest_of[piece.region], piece.box.diagonal().norm());

  std::vector<int> place(pieces.size(), -1);
  size_t specks = 0, islets = 0;
  for (size_t p = 0; p < pieces.size(); ++p) {
    const bool islet =
        pieces[p].region >= 0 && pieces[p].box.diagonal().norm() < kIslet * largest_of[pieces[p].region];
    if (pieces[p].vertices < kFewestVertices)
      ++specks;
    else if (islet)
      ++islets;
    else
      place[p] = found.count++, found.region.push_back(pieces[p].region);
  }
  for (size_t v = 0; v < found.part.size(); ++v) {
    if (found.part[v] >= 0) found.part[v] = place[static_cast<size_t>(found.part[v])];
    if (soft[v] && found.part[static_cast<size_t>(character.welded[v])] < 0) stiffness.of_vertex[v] = 1;
  }
  if (specks > 0)
    character.notes.push_back(std::to_string(specks) + " soft parts of fewer than four vertices: held rigid");
  if (islets > 0)
    character.notes.push_back(
        std::to_string(islets) +
        " soft parts that are small compared with the rest of their region: held rigid");
  return found;
}

std::vector<int> part_vertices(const Surface& surface, const SoftParts& parts, int id) {
  std::vector<int> vertices;
  for (size_t v = 0; v < parts.part.size(); ++v)
    if (parts.part[v] == id && !surface.lies(v)) vertices.push_back(static_cast<int>(v));
  return vertices;
}

std::vector<int> rim_vertices(const Surface& surface, const SoftParts& parts, int id) {
  std::set<int> rim;
  for (size_t v = 0; v < parts.part.size(); ++v) {
    if (parts.part[v] != id || surface.lies(v)) continue;
    for (int next : surface.neighbours[v])
      if (parts.part[static_cast<size_t>(next)] < 0 && !surface.lies(static_cast<size_t>(next)))
        rim.insert(next);
  }
  return {rim.begin(), rim.end()};
}

int frame_joint(const Character& character, const std::vector<int>& rim, const std::vector<int>& vertices) {
  const std::vector<int>& where = rim.empty() ? vertices : rim;
  return largest(weight_a_joint(character, where, std::vector<double>(where.size(), 1)));
}

const RegionRecipe* stated_region(const Character& character, const Surface& surface, const Recipe& recipe,
                                  const std::vector<double>& stiffness, const std::vector<int>& vertices) {
  const RegionRecipe* stated = nullptr;
  double best = 0, all = 0;
  for (double value : soft_weight(character, stiffness, vertices)) all += value;
  for (const RegionRecipe& region : recipe.regions) {
    const RegionScope scope = scope_of(character, surface, region);
    std::vector<int> own;
    for (const int v : vertices)
      if (scope.vertices[static_cast<size_t>(v)]) own.push_back(v);
    const std::vector<double> weight = soft_weight(character, stiffness, own);
    double sum = 0;
    for (size_t j = 0; j < weight.size(); ++j) sum += scope.joints[j] ? weight[j] : 0;
    if (sum > best) best = sum, stated = &region;
  }
  return best > all / 2 ? stated : nullptr;
}

std::string region_name(const Character& character, const std::vector<double>& stiffness,
                        const std::vector<int>& vertices) {
  return joint_name(character, static_cast<size_t>(largest(soft_weight(character, stiffness, vertices))));
}

void distinguish_names(std::vector<Region>& regions) {
  std::map<std::string, std::vector<Region*>> same;
  for (Region& region : regions) same[region.name].push_back(&region);
  for (auto& [name, list] : same) {
    if (list.size() < 2) continue;
    const bool pair = list.size() == 2 && list[0]->center.x() * list[1]->center.x() < 0;
    for (size_t i = 0; i < list.size(); ++i)
      list[i]->name.append("_").append(!pair ? std::to_string(i + 1) : list[i]->center.x() > 0 ? "l" : "r");
  }
}

}  // namespace sinew::baker

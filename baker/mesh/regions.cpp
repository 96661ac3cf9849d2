// regions.cpp  Soft parts, their frames and names.
#include "baker/mesh/regions.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "baker/mesh/joint_names.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kFewestVertices = 4;  // fewer have no inside and no volume to speak of

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

// Of each joint, where the part is soft.
std::vector<double> soft_weight(const Character& character, const std::vector<double>& stiffness,
                                const std::vector<int>& vertices) {
  std::vector<double> softness;
  for (int v : vertices) softness.push_back(1 - stiffness[static_cast<size_t>(v)]);
  return weight_a_joint(character, vertices, softness);
}

}  // namespace

SoftParts find_soft_parts(Character& character, const Surface& surface, const Recipe& recipe,
                          std::vector<double>& stiffness) {
  std::vector<bool> soft(stiffness.size());
  for (size_t v = 0; v < soft.size(); ++v) soft[v] = stiffness[v] < recipe.rigid_stiffness;
  SoftParts found{connected_parts(surface, soft), 0};
  std::vector<size_t> size;
  for (int part : found.part)
    if (part >= 0)
      size.resize(std::max(size.size(), static_cast<size_t>(part) + 1)), ++size[static_cast<size_t>(part)];

  std::vector<int> place(size.size(), -1);
  size_t dropped = 0;
  for (size_t part = 0; part < size.size(); ++part)
    if (size[part] >= kFewestVertices)
      place[part] = found.count++;
    else
      ++dropped;
  for (size_t v = 0; v < found.part.size(); ++v) {
    if (found.part[v] >= 0) found.part[v] = place[static_cast<size_t>(found.part[v])];
    if (soft[v] && found.part[static_cast<size_t>(character.welded[v])] < 0) stiffness[v] = 1;
  }
  if (dropped > 0)
    character.notes.push_back(std::to_string(dropped) +
                              " soft parts of fewer than four vertices: held rigid");
  return found;
}

std::vector<int> part_vertices(const SoftParts& parts, int id) {
  std::vector<int> vertices;
  for (size_t v = 0; v < parts.part.size(); ++v)
    if (parts.part[v] == id) vertices.push_back(static_cast<int>(v));
  return vertices;
}

std::vector<int> rim_vertices(const Surface& surface, const SoftParts& parts, int id) {
  std::set<int> rim;
  for (size_t v = 0; v < parts.part.size(); ++v) {
    if (parts.part[v] != id) continue;
    for (int next : surface.neighbours[v])
      if (parts.part[static_cast<size_t>(next)] < 0) rim.insert(next);
  }
  return {rim.begin(), rim.end()};
}

int frame_joint(const Character& character, const std::vector<int>& rim, const std::vector<int>& vertices) {
  const std::vector<int>& where = rim.empty() ? vertices : rim;
  return largest(weight_a_joint(character, where, std::vector<double>(where.size(), 1)));
}

const RegionRecipe* stated_region(const Character& character, const Recipe& recipe,
                                  const std::vector<double>& stiffness, const std::vector<int>& vertices) {
  const std::vector<double> weight = soft_weight(character, stiffness, vertices);
  const RegionRecipe* stated = nullptr;
  double best = 0, all = 0;
  for (double value : weight) all += value;
  for (const RegionRecipe& region : recipe.regions) {
    const std::vector<bool> joints =
        match_joints(character, region.joints, "recipe: region '" + region.name + "'");
    double sum = 0;
    for (size_t j = 0; j < joints.size(); ++j) sum += joints[j] ? weight[j] : 0;
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

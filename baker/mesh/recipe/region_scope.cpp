// region_scope.cpp  see region_scope.hpp.
#include "baker/mesh/recipe/region_scope.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <set>

#include "baker/common/bad_input.hpp"
#include "baker/common/edit_distance.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

using Vertices = std::vector<bool>;

bool matches(const std::string& given, const std::string& name) {
  if (name.ends_with('*')) return given.starts_with(name.substr(0, name.size() - 1));
  return given == name;
}

// "'Mage_Cape', 'Mage_Hat' and 3 more", the likeliest first.
std::string listed(const std::set<std::string>& names, const std::string& meant) {
  constexpr size_t kMostListed = 8;
  std::vector<std::string> sorted(names.begin(), names.end());
  std::ranges::stable_sort(sorted, {}, [&](const std::string& name) { return edit_distance(name, meant); });
  std::string list;
  for (size_t i = 0; i < std::min(kMostListed, sorted.size()); ++i)
    list += (i > 0 ? ", '" : "'") + sorted[i] + "'";
  if (sorted.size() > kMostListed) list += " and " + std::to_string(sorted.size() - kMostListed) + " more";
  return list;
}

[[noreturn]] void refuse_name(const std::string& where, const char* what, const std::string& name,
                              std::set<std::string> names) {
  names.erase("");
  throw BadInput(where + ": no " + what + " is named '" + name + "'; " +
                 (names.empty() ? "the file names none" : "there are " + listed(names, name)));
}

Vertices of_mesh(const Character& character, const std::string& name, const std::string& where) {
  Vertices in(character.positions.size(), false);
  std::set<std::string> names;
  bool found = false;
  for (const MeshSpan& mesh : character.meshes)
    for (const std::string& given : {character.nodes[static_cast<size_t>(mesh.node)].name, mesh.name}) {
      names.insert(given);
      if (!matches(given, name)) continue;
      found = true;
      for (size_t v = 0; v < mesh.vertex_count; ++v) in[mesh.first_vertex + v] = true;
    }
  if (!found) refuse_name(where, "mesh", name, std::move(names));
  return in;
}

Vertices of_material(const Character& character, const std::string& name, const std::string& where) {
  Vertices in(character.positions.size(), false);
  std::set<std::string> names;
  bool found = false;
  for (const MaterialVertices& material : character.materials) {
    names.insert(material.name);
    if (!matches(material.name, name)) continue;
    found = true;
    for (const int v : material.vertices) in[static_cast<size_t>(v)] = true;
  }
  if (!found) refuse_name(where, "material", name, std::move(names));
  return in;
}

// A piece is whole where a seam or another primitive has doubled its border.
void weld(const Character& character, Vertices& in) {
  for (size_t v = 0; v < in.size(); ++v)
    if (in[v]) in[static_cast<size_t>(character.welded[v])] = true;
  for (size_t v = 0; v < in.size(); ++v) in[v] = in[static_cast<size_t>(character.welded[v])];
}

void keep_common(const Vertices& other, Vertices& in) {
  for (size_t v = 0; v < in.size(); ++v) in[v] = in[v] && other[v];
}

std::string text_of(const Vector3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "[%.3g, %.3g, %.3g]", p.x(), p.y(), p.z());
  return text;
}

// The connected piece with the vertex of `in` that is nearest to the place.
Vertices of_island(const Character& character, const Surface& surface, const Vector3& at, const Vertices& in,
                   const std::string& where) {
  double nearest_m = std::numeric_limits<double>::infinity();
  size_t nearest = 0;
  for (size_t v = 0; v < in.size(); ++v) {
    if (!in[v] || surface.neighbours[v].empty()) continue;
    const double distance_m = (character.positions[v] - at).norm();
    if (distance_m < nearest_m) nearest_m = distance_m, nearest = v;
  }
  const double reach_m = kIslandReach * bind_height(character);
  if (nearest_m > std::numeric_limits<double>::max())
    throw BadInput(where + ": island_at is looked for in what has no triangles");
  if (!(nearest_m <= reach_m)) {
    char text[160];
    std::snprintf(text, sizeof text, ": no surface within %.3g m of island_at %s; the nearest is %.3g m away",
                  reach_m, text_of(at).c_str(), nearest_m);
    throw BadInput(where + text + ", at " + text_of(character.positions[nearest]));
  }
  const std::vector<int> island = connected_parts(surface, Vertices(in.size(), true));
  Vertices out(in.size(), false);
  for (size_t v = 0; v < in.size(); ++v) out[v] = island[v] == island[nearest];
  return out;
}

}  // namespace

bool selects_piece(const RegionRecipe& region) {
  return !region.mesh.empty() || !region.material.empty() || region.island_at.has_value();
}

RegionScope scope_of(const Character& character, const Surface& surface, const RegionRecipe& region) {
  const std::string who = "recipe: region '" + region.name + "'", where = character.name + ": " + who;
  RegionScope scope{match_joints(character, region.joints, who), Vertices(character.positions.size(), true)};
  if (region.joints.empty()) scope.joints.assign(scope.joints.size(), true);
  if (!region.mesh.empty()) keep_common(of_mesh(character, region.mesh, where), scope.vertices);
  if (!region.material.empty()) keep_common(of_material(character, region.material, where), scope.vertices);
  weld(character, scope.vertices);
  if (std::ranges::find(scope.vertices, true) == scope.vertices.end())
    throw BadInput(where + ": mesh '" + region.mesh + "' has nothing of material '" + region.material +
                   "'; name one of them");
  if (region.island_at)
    keep_common(of_island(character, surface, *region.island_at, scope.vertices, where), scope.vertices);
  weld(character, scope.vertices);
  return scope;
}

}  // namespace sinew::baker

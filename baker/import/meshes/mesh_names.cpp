// mesh_names.cpp  Names and prefixes; the nearest name by edit distance.
#include "baker/import/meshes/mesh_names.hpp"

#include <algorithm>

#include "baker/common/edit_distance.hpp"

namespace sinew::baker {
namespace {

bool matches(const std::string& given, const std::string& name) {
  if (name.ends_with('*')) return given.starts_with(name.substr(0, name.size() - 1));
  return given == name;
}

}  // namespace

std::vector<bool> match_meshes(const tinygltf::Model& model, const SceneGraph& graph,
                               const std::vector<std::string>& names, const std::string& key,
                               const Source& source, const std::vector<MeshInstance>& instances) {
  const auto names_of = [&](const MeshInstance& instance) {
    return std::array{model.meshes[static_cast<size_t>(instance.mesh)].name,
                      graph.nodes[static_cast<size_t>(instance.node)].name};
  };
  std::vector<bool> matched(instances.size(), false);
  for (const std::string& name : names) {
    bool found = false;
    std::string nearest;
    for (size_t i = 0; i < instances.size(); ++i)
      for (const std::string& given : names_of(instances[i])) {
        if (matches(given, name)) matched[i] = found = true;
        if (!given.empty() && (nearest.empty() || edit_distance(given, name) < edit_distance(nearest, name)))
          nearest = given;
      }
    if (!found)
      source.refuse("recipe: " + key, "no mesh is named '" + name + "'",
                    nearest.empty() ? "its meshes have no names; name them and export again"
                                    : "the nearest is '" + nearest + "'");
  }
  return matched;
}

void leave_out_meshes(const tinygltf::Model& model, const SceneGraph& graph,
                      const std::vector<std::string>& names, Source& source,
                      std::vector<MeshInstance>& instances) {
  const std::vector<bool> out = match_meshes(model, graph, names, "without_meshes", source, instances);
  std::vector<MeshInstance> kept;
  for (size_t i = 0; i < instances.size(); ++i)
    if (!out[i]) kept.push_back(instances[i]);
  if (kept.empty()) source.refuse("recipe: without_meshes", "leaves every mesh out", "let it name fewer");
  if (kept.size() < instances.size())
    source.note("", std::to_string(instances.size() - kept.size()) + " of " +
                        std::to_string(instances.size()) + " meshes are left out, as the recipe says");
  instances = std::move(kept);
}

}  // namespace sinew::baker

// shown_meshes.cpp  Levels of detail by their names, visibility by its extension.
#include "baker/import/meshes/shown_meshes.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include "baker/import/gltf/vrm_values.hpp"
#include "baker/import/meshes/mesh_names.hpp"

namespace sinew::baker {
namespace {

bool is_separator(char c) { return c == '_' || c == '-' || c == '.' || c == ' '; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

constexpr int kMostAbove = 8;  // nodes from a mesh up to the group that is a level

struct Leveled {
  std::string rest;  // the name without its level
  int level = 0;
};

// Copies that Blender numbers: body_LOD1.001.
std::string without_copy_number(const std::string& name) {
  const size_t dot = name.rfind('.');
  const bool numbered =
      dot != std::string::npos && dot + 4 == name.size() &&
      std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1, name.end(), is_digit);
  return numbered ? name.substr(0, dot) : name;
}

std::string in_small_letters(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

// "body_LOD1", "LOD_1_body", "bodylod1", "body_LOD0Shape"; nothing where the name says no level.
std::optional<Leveled> level_in(const std::string& name) {
  const std::string small = in_small_letters(name);
  for (size_t at = small.find("lod"); at != std::string::npos; at = small.find("lod", at + 1)) {
    size_t digits = at + 3;
    if (digits < small.size() && is_separator(small[digits])) ++digits;
    size_t end = digits;
    while (end < small.size() && is_digit(small[end]) && end < digits + 3) ++end;
    if (end == digits || (end < small.size() && is_digit(small[end]))) continue;
    const size_t begin = at > 0 && is_separator(small[at - 1]) ? at - 1 : at;
    return Leveled{without_copy_number(small.substr(0, begin) + small.substr(end)),
                   std::stoi(small.substr(digits, end - digits))};
  }
  return std::nullopt;
}

class Chooser {
 public:
  Chooser(const tinygltf::Model& model, const SceneGraph& graph, const std::vector<MeshInstance>& instances)
      : model_(model), graph_(graph), instances_(instances), out_(instances.size(), false) {}

  // Named in the notes as artists see them: by their nodes.
  void leave_out_invisible(const std::vector<bool>& kept, Source& source) {
    std::vector<bool> invisible(graph_.nodes.size(), false);
    for (size_t file = 0; file < model_.nodes.size(); ++file) {
      const auto found = model_.nodes[file].extensions.find("KHR_node_visibility");
      if (found == model_.nodes[file].extensions.end()) continue;
      const tinygltf::Value& visible = part(found->second, "visible");
      if (visible.IsBool() && !visible.Get<bool>())
        invisible[static_cast<size_t>(graph_.node_of_file[file])] = true;
    }
    leave_out(below(std::move(invisible)), kept, "not visible (KHR_node_visibility)", source);
  }

  void leave_out_listed_levels(const std::vector<bool>& kept, Source& source) {
    std::vector<bool> lesser(graph_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes) {
      const auto found = node.extensions.find("MSFT_lod");
      if (found == node.extensions.end()) continue;
      for (const tinygltf::Value& id : list(part(found->second, "ids")))
        if (const int index = node_of(graph_, id); index >= 0) lesser[static_cast<size_t>(index)] = true;
    }
    leave_out(below(std::move(lesser)), kept, "lesser levels of detail (MSFT_lod)", source);
  }

  void leave_out_named_levels(const std::vector<bool>& kept, Source& source) {
    std::map<std::string, std::vector<std::pair<int, size_t>>> alike;  // level, instance
    for (size_t i = 0; i < instances_.size(); ++i)
      if (const std::optional<Leveled> leveled = level_of(instances_[i]); leveled && !out_[i])
        alike[leveled->rest].emplace_back(leveled->level, i);
    for (size_t i = 0; i < instances_.size(); ++i)
      if (const auto found = alike.find(key_without_level(instances_[i]));
          found != alike.end() && !out_[i] && !level_of(instances_[i]))
        found->second.emplace_back(0, i);
    for (const auto& [rest, meshes] : alike) {
      const int finest = std::ranges::min(meshes).first;
      std::vector<bool> lesser(instances_.size(), false);
      for (const auto& [level, i] : meshes) lesser[i] = level > finest;
      note_and_leave_out(lesser, kept, "lesser levels of detail", source);
    }
  }

  std::vector<bool> take() { return std::move(out_); }

 private:
  std::vector<bool> below(std::vector<bool> nodes) const {
    for (size_t i = 0; i < nodes.size(); ++i) {  // parents come first
      const int up = graph_.nodes[i].parent;
      if (up >= 0 && nodes[static_cast<size_t>(up)]) nodes[i] = true;
    }
    return nodes;
  }

  // By the name of the node, or of a group above it, else by the mesh's own. What stands below one parent and
  // is called alike but for the level is alike; of groups all that is in them, whatever it is called.
  std::optional<Leveled> level_of(const MeshInstance& instance) const {
    int node = instance.node;
    for (int up = 0; node >= 0 && up < kMostAbove; ++up, node = parent_of(node))
      if (const auto found = level_in(graph_.nodes[static_cast<size_t>(node)].name))
        return Leveled{key(parent_of(node), found->rest), found->level};
    if (const auto found = level_in(model_.meshes[static_cast<size_t>(instance.mesh)].name))
      return Leveled{key(parent_of(instance.node), found->rest), found->level};
    return std::nullopt;
  }

  // Of "body" beside "body_LOD1".
  std::string key_without_level(const MeshInstance& instance) const {
    const std::string& name = graph_.nodes[static_cast<size_t>(instance.node)].name;
    return key(parent_of(instance.node), without_copy_number(in_small_letters(name)));
  }

  static std::string key(int parent, const std::string& name) { return std::to_string(parent) + "/" + name; }

  int parent_of(int node) const { return graph_.nodes[static_cast<size_t>(node)].parent; }

  void leave_out(const std::vector<bool>& nodes, const std::vector<bool>& kept, const std::string& why,
                 Source& source) {
    std::vector<bool> those(instances_.size(), false);
    for (size_t i = 0; i < those.size(); ++i)
      those[i] = !out_[i] && nodes[static_cast<size_t>(instances_[i].node)];
    note_and_leave_out(those, kept, why, source);
  }

  void note_and_leave_out(const std::vector<bool>& those, const std::vector<bool>& kept,
                          const std::string& why, Source& source) {
    std::string names;
    for (size_t i = 0; i < those.size(); ++i) {
      if (!those[i] || kept[i]) continue;
      out_[i] = true;
      names +=
          (names.empty() ? "'" : ", '") + graph_.nodes[static_cast<size_t>(instances_[i].node)].name + "'";
    }
    if (!names.empty())
      source.note("", "left out as " + why + ": " + names +
                          "; a recipe's \"with_meshes\" keeps them, \"without_meshes\" leaves out others");
  }

  const tinygltf::Model& model_;
  const SceneGraph& graph_;
  const std::vector<MeshInstance>& instances_;
  std::vector<bool> out_;
};

}  // namespace

void keep_shown_meshes(const tinygltf::Model& model, const SceneGraph& graph,
                       const std::vector<std::string>& kept_names, Source& source,
                       std::vector<MeshInstance>& instances) {
  const std::vector<bool> kept = match_meshes(model, graph, kept_names, "with_meshes", source, instances);
  Chooser chooser(model, graph, instances);
  chooser.leave_out_invisible(kept, source);
  chooser.leave_out_listed_levels(kept, source);
  chooser.leave_out_named_levels(kept, source);
  const std::vector<bool> out = chooser.take();
  std::vector<MeshInstance> shown;
  for (size_t i = 0; i < instances.size(); ++i)
    if (!out[i]) shown.push_back(instances[i]);
  if (shown.empty())
    source.refuse("", "all of its meshes are invisible or lesser levels of detail",
                  "show one, or name it in a recipe's \"with_meshes\"");
  instances = std::move(shown);
}

}  // namespace sinew::baker

// recipe.cpp  The tissue recipe's JSON, every key checked.
#include "baker/mesh/recipe/recipe.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "baker/common/files/json_section.hpp"
#include "pack/format.hpp"

namespace sinew::baker {
namespace {

int whole_number(JsonSection& section, const std::string& key, int otherwise, int low, int high) {
  const double number = section.number(key, otherwise, low, high);
  if (number != std::floor(number)) section.complain(key, "must be a whole number");
  return static_cast<int>(number);
}

void read_material(JsonSection& section, Recipe& recipe) {
  recipe.states_moduli = section.has("young_soft_pa") || section.has("young_stiff_pa");
  recipe.young_soft_pa = section.number("young_soft_pa", recipe.young_soft_pa, 1, 1e9);
  recipe.young_stiff_pa =
      section.number("young_stiff_pa", std::max(recipe.young_stiff_pa, recipe.young_soft_pa), 1, 1e9);
  if (recipe.young_stiff_pa < recipe.young_soft_pa)
    section.complain("young_stiff_pa", "is smaller than young_soft_pa");
  recipe.poisson_ratio = section.number("poisson_ratio", recipe.poisson_ratio, 0, 0.49);
  recipe.density_kg_m3 = section.number("density_kg_m3", recipe.density_kg_m3, 1, 1e5);
  recipe.damping_ratio = section.number("damping_ratio", recipe.damping_ratio, 0, 1);
  if (section.has("max_displacement"))
    recipe.max_displacement = section.number("max_displacement", 0, 0.01, 4);
  if (section.has("voxels_high"))
    recipe.voxels_high = whole_number(section, "voxels_high", kUsualVoxelsHigh, 8, 200);
  recipe.rigid_stiffness = section.number("rigid_stiffness", recipe.rigid_stiffness, 0.01, 1);
  recipe.core_share = section.number("core_share", recipe.core_share, 0, 1);
  recipe.coreless_joints = section.texts("coreless_joints");
}

constexpr int kFewestNodes = 4, kMostNodes = 4096;

// "levels": [40, 20, 10] in the place of "nodes_per_region", "left_out": ["cheek"] with it.
void read_levels(JsonSection& section, Recipe& recipe) {
  if (section.has("nodes_per_region")) section.complain("levels", "states nodes_per_region too; give one");
  std::vector<int> levels = section.whole_numbers("levels", kFewestNodes, kMostNodes);
  if (levels.empty() || levels.size() > pack::kMostGraphLevels)
    section.complain("levels", "must list 1 .. 4 numbers of nodes a region");
  if (std::ranges::adjacent_find(levels, std::less_equal<>()) != levels.end())
    section.complain("levels", "must descend: the finest control graph comes first");
  recipe.left_out = section.texts("left_out");
  if (!recipe.left_out.empty() && levels.size() == pack::kMostGraphLevels)
    section.complain("left_out", "asks for one control graph more than the 4 of levels; list one less there");
  recipe.nodes_per_region = levels.front();
  recipe.coarser_nodes.assign(levels.begin() + 1, levels.end());
}

void read_graph(JsonSection& section, Recipe& recipe) {
  if (section.has("levels"))
    read_levels(section, recipe);
  else if (section.has("left_out"))
    section.complain("left_out", "needs levels: its control graph comes after them");
  else if (section.has("nodes_per_region")) {
    recipe.nodes_per_region =
        whole_number(section, "nodes_per_region", recipe.nodes_per_region, kFewestNodes, kMostNodes);
    recipe.coarser_nodes.clear();
  }
  recipe.neighbours = whole_number(section, "neighbours", recipe.neighbours, 2, 16);
  if (section.has("layer_m")) recipe.layer_m = section.number("layer_m", 0, 0, 10);
  recipe.unit_m = section.number("unit_m", recipe.unit_m, 0, 1e6);
  const std::string up = section.text("up", std::string(1, recipe.up));
  if (up != "y" && up != "z") section.complain("up", "is \"" + up + "\"; it must be \"y\" or \"z\"");
  recipe.up = up[0];
}

// Of flesh over bones: a piece is soft where it sticks out.
void read_side(JsonSection& section, RegionRecipe& region) {
  for (const char* key : {"side", "around"})
    for (const char* piece : {"mesh", "material", "island_at"})
      if (section.has(key) && section.has(piece))
        section.complain(key, std::string("is of soft tissue over bones, not of a piece; take it or \"") +
                                  piece + "\" out");
  if (section.has("side")) {
    region.side = side_called(section.text("side"));
    if (!region.side)
      section.complain("side", "is none of " + side_names() + "; all sides are \"around\": true");
  }
  if (!section.flag("around", false)) return;
  if (region.side) section.complain("around", "means all sides, and a side is stated too; give one");
  region.side = BodySide::kAround;
}
constexpr double kFarthest_m = 1e7;  // as far as the import lets a vertex lie

bool read_emulated(JsonSection& section) {
  const std::string model = section.text("model", "alt_conv_lstm");
  if (model != "alt_conv_lstm" && model != "deep_emulator")
    section.complain("model", "is \"" + model + "\"; it must be \"alt_conv_lstm\" or \"deep_emulator\"");
  return model == "deep_emulator";
}

RegionRecipe read_region(JsonSection& section) {
  RegionRecipe region;
  region.name = section.text("name");
  region.joints = section.texts("joints");
  if (section.has("mesh")) region.mesh = section.text("mesh");
  if (section.has("material")) region.material = section.text("material");
  if (section.has("island_at"))
    region.island_at = section.vector3("island_at", Eigen::Vector3d::Zero(), -kFarthest_m, kFarthest_m);
  if (region.joints.empty() && region.mesh.empty() && region.material.empty() && !region.island_at)
    section.complain("joints",
                     "must name at least one joint, or a prefix*; or name a piece by mesh, material or "
                     "island_at");
  region.stiffness = section.number("stiffness", region.stiffness, 0, 1);
  region.touches_body = section.flag("touches_body", region.touches_body);
  if (section.has("model")) region.emulated = read_emulated(section);
  if (section.has("kind")) {
    const std::optional<SoftKind> kind = kind_called(section.text("kind"));
    if (!kind) section.complain("kind", "is none of " + kind_names());
    region.kind = kind;
  }
  read_side(section, region);
  if (section.has("frequency_hz")) region.frequency_hz = section.number("frequency_hz", 0, 0.05, 25);
  if (section.has("damping_ratio")) region.damping_ratio = section.number("damping_ratio", 0, 0, 0.95);
  region.intensity = section.number("intensity", region.intensity, 0, 2);
  if (section.has("max_displacement"))
    region.max_displacement = section.number("max_displacement", 0, 0.01, 4);
  section.finish();
  return region;
}

ProxyRecipe read_proxy(JsonSection& section) {
  ProxyRecipe proxy;
  proxy.joint = section.text("joint");
  proxy.radius_m = section.number("radius_m", 0, 1e-3, 10);
  section.finish();
  return proxy;
}

}  // namespace

Recipe read_recipe(const std::string& path) {
  const JsonFile file = read_json_file(path);
  JsonSection section(file);
  Recipe recipe;
  section.text("note", "");
  read_material(section, recipe);
  read_graph(section, recipe);
  recipe.emulated = read_emulated(section);
  recipe.states_regions = section.has("regions");
  for (JsonSection& region : section.sections("regions")) {
    region.text("note", "");
    const bool enabled = region.flag("enabled", true);
    const RegionRecipe read = read_region(region);
    if (enabled) recipe.regions.push_back(read);
  }
  recipe.without_meshes = section.texts("without_meshes");
  recipe.with_meshes = section.texts("with_meshes");
  for (JsonSection& proxy : section.sections("proxies")) recipe.proxies.push_back(read_proxy(proxy));
  recipe.without_proxies = section.texts("without_proxies");
  if (section.has("rods")) recipe.rods = read_rod_recipes(section);
  section.finish();
  return recipe;
}

}  // namespace sinew::baker

// layout_tissue.cpp  The steps from a character to its soft regions and their control graph.
#include <algorithm>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/carry.hpp"
#include "baker/mesh/control_nodes.hpp"
#include "baker/mesh/node_order.hpp"
#include "baker/mesh/regions.hpp"
#include "baker/mesh/stiffness.hpp"
#include "baker/mesh/tissue_layout.hpp"

namespace sinew::baker {
namespace {

constexpr int kRimAnchors = 120;  // they cost time in the baker only

std::vector<Vector3> places(const Character& character, const std::vector<int>& vertices) {
  std::vector<Vector3> result;
  for (int v : vertices) result.push_back(character.positions[static_cast<size_t>(v)]);
  return result;
}

// All of the file's vertices that are welded to one of the part.
std::vector<int> carried_vertices(const Character& character, const SoftParts& parts, int id) {
  std::vector<int> vertices;
  for (size_t v = 0; v < character.welded.size(); ++v)
    if (parts.part[static_cast<size_t>(character.welded[v])] == id) vertices.push_back(static_cast<int>(v));
  return vertices;
}

void append_nodes(const Character& character, const std::vector<int>& nodes, int region,
                  TissueLayout& layout) {
  for (int v : nodes) {
    const auto at = static_cast<size_t>(v);
    layout.nodes.push_back({v, region, character.positions[at], character.normals[at], layout.stiffness[at],
                            character.skin[at]});
  }
}

void measure(const std::vector<Vector3>& nodes, Region& region) {
  for (const Vector3& node : nodes) region.center += node / static_cast<double>(nodes.size());
  for (const Vector3& node : nodes)
    region.radius_m = std::max(region.radius_m, (node - region.center).norm());
}

using Edges = std::vector<std::pair<int, int>>;

// Farthest points are sampled from all over a part. A few stay in cache in any order, and keep theirs; many
// are put so that neighbours stand near each other.
void order_for_cache(std::vector<int>& nodes, Edges& edges) {
  constexpr size_t kFew = 256;
  if (nodes.size() <= kFew) return;
  const std::vector<int> order = order_by_neighbours(nodes.size(), edges), given = nodes;
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) {
    nodes[k] = given[static_cast<size_t>(order[k])];
    place[static_cast<size_t>(order[k])] = static_cast<int>(k);
  }
  for (auto& [a, b] : edges) {
    const auto [first, second] = std::minmax(place[static_cast<size_t>(a)], place[static_cast<size_t>(b)]);
    a = first, b = second;
  }
  std::ranges::sort(edges);
}

// A part of the surface that becomes a region.
struct Part {
  const Character& character;
  const Surface& surface;
  const SoftParts& parts;
  int id;
  std::vector<int> vertices = part_vertices(parts, id), rim = rim_vertices(surface, parts, id);
  PartSurface view() const { return {character, surface, parts.part, id, vertices, rim}; }
};

// What it moves like: as stated, else by its kind and size, or by the recipe's moduli.
void set_motion(const Recipe& recipe, const RegionRecipe* stated, Region& region) {
  const RegionRecipe fallback;
  const RegionRecipe& from = stated ? *stated : fallback;
  region.kind = from.kind;
  region.damping_ratio = from.damping_ratio.value_or(recipe.damping_ratio);
  region.intensity = from.intensity;
  region.max_displacement = from.max_displacement.value_or(recipe.max_displacement);
  if (from.frequency_hz)
    region.frequency_hz = *from.frequency_hz;
  else if (!recipe.states_moduli)
    region.frequency_hz = default_frequency_hz(region.kind, 2 * region.radius_m);
}

void append_region(const Part& part, const Recipe& recipe, const std::vector<int>& nodes, const Edges& edges,
                   TissueLayout& layout) {
  const Character& character = part.character;
  Region region;
  const RegionRecipe* stated = stated_region(character, recipe, layout.stiffness, part.vertices);
  region.name = stated ? stated->name : region_name(character, layout.stiffness, part.vertices);
  region.touches_body = stated && stated->touches_body;
  region.frame_joint = frame_joint(character, part.rim, part.vertices);
  region.first_node = static_cast<int>(layout.nodes.size());
  region.node_count = static_cast<int>(nodes.size());
  region.vertices = carried_vertices(character, part.parts, part.id);
  const std::vector<Vector3> node_places = places(character, nodes);
  measure(node_places, region);
  set_motion(recipe, stated, region);
  region.carry = carry_weights(node_places, places(character, sample_rim(character, part.rim, kRimAnchors)),
                               places(character, region.vertices));
  for (const auto& [a, b] : edges) layout.edges.emplace_back(region.first_node + a, region.first_node + b);
  append_nodes(character, nodes, static_cast<int>(layout.regions.size()), layout);
  layout.regions.push_back(std::move(region));
}

void append_finest(const Part& part, const Recipe& recipe, TissueLayout& layout) {
  std::vector<int> nodes = sample_nodes(part.view(), layout.stiffness, recipe.nodes_per_region);
  Edges edges = connect_nodes(part.view(), nodes, recipe.neighbours);
  order_for_cache(nodes, edges);
  append_region(part, recipe, nodes, edges, layout);
}

// In the order in which the finest region has them.
void put_in_order_of(const TissueLayout& finest, const Region& region, std::vector<int>& nodes) {
  const auto begin = finest.nodes.begin() + region.first_node;
  const auto place = [&](int vertex) {
    return std::find_if(begin, begin + region.node_count,
                        [&](const ControlNode& node) { return node.vertex == vertex; });
  };
  std::ranges::sort(nodes, {}, place);
}

void append_coarser(const Part& part, const Recipe& recipe, const TissueLayout& finest, int held, int count,
                    TissueLayout& layout) {
  const Region& region = finest.regions[static_cast<size_t>(part.id)];
  std::vector<int> nodes = sample_nodes(part.view(), layout.stiffness, std::min(count, region.node_count));
  if (std::ranges::find(nodes, held) == nodes.end()) nodes.back() = held;
  put_in_order_of(finest, region, nodes);
  append_region(part, recipe, nodes, connect_nodes(part.view(), nodes, recipe.neighbours), layout);
  layout.regions.back().name = region.name;
  layout.regions.back().center = region.center;
  layout.regions.back().radius_m = region.radius_m;
  layout.regions.back().frequency_hz = region.frequency_hz;
}

// Flesh that a rod's bones move by more than this is not soft: rim of both, it would swing twice.
constexpr double kRodWeight = 0.05;

void hold_on_rods(const Character& character, const std::vector<Rod>& rods, std::vector<double>& stiffness) {
  const std::vector<bool> on = joints_on_rods(character, rods);
  for (size_t v = 0; v < stiffness.size(); ++v) {
    const Influences& skin = character.skin[static_cast<size_t>(character.welded[v])];
    double weight = 0;
    for (size_t k = 0; k < kInfluences; ++k)
      if (on[static_cast<size_t>(skin.joint[k])]) weight += skin.weight[k];
    if (weight > kRodWeight) stiffness[v] = 1;
  }
}

}  // namespace

TissueLayout layout_tissue(Character& character, const Recipe& recipe) {
  const Surface surface = find_surface(character);
  TissueLayout layout;
  layout.rods = find_rods(character, recipe);
  layout.proxies =
      find_proxies(character, find_bones(character, {}), joints_on_rods(character, layout.rods), recipe);
  layout.stiffness = find_stiffness(character, surface, recipe);
  hold_on_rods(character, layout.rods, layout.stiffness);
  const SoftParts parts = find_soft_parts(character, surface, recipe, layout.stiffness);
  if (parts.count == 0 && layout.rods.empty())
    throw BadInput(character.name + ": no part of the surface is soft (stiffness below " +
                   std::to_string(recipe.rigid_stiffness) +
                   "); paint _STIFFNESS, or name soft joints in the recipe's regions");
  for (int id = 0; id < parts.count; ++id) append_finest({character, surface, parts, id}, recipe, layout);
  distinguish_names(layout.regions);
  return layout;
}

TissueLayout coarser_layout(const Character& character, const Recipe& recipe, const TissueLayout& finest,
                            const std::vector<int>& held, int nodes_per_region) {
  Character again = character;  // its notes were made with the finest
  const Surface surface = find_surface(again);
  TissueLayout layout;
  layout.stiffness = finest.stiffness;
  const SoftParts parts = find_soft_parts(again, surface, recipe, layout.stiffness);
  for (int id = 0; id < parts.count; ++id)
    append_coarser({again, surface, parts, id}, recipe, finest, held[static_cast<size_t>(id)],
                   nodes_per_region, layout);
  return layout;
}

}  // namespace sinew::baker

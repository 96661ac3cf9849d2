// layout_tissue.cpp  The steps from a character to its soft regions and their control graph.
#include <algorithm>
#include <cstdio>
#include <set>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/anatomy/anatomy.hpp"
#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/graph/carry.hpp"
#include "baker/mesh/graph/control_nodes.hpp"
#include "baker/mesh/graph/node_order.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/parts/named_parts.hpp"
#include "baker/mesh/parts/piece_softness.hpp"
#include "baker/mesh/recipe/region_scope.hpp"
#include "baker/mesh/regions/clip_frequency.hpp"
#include "baker/mesh/regions/layers.hpp"
#include "baker/mesh/regions/regions.hpp"
#include "baker/mesh/regions/stiffness.hpp"
#include "baker/mesh/rods/crossed_capsules.hpp"
#include "baker/mesh/rods/hold_roots.hpp"
#include "baker/mesh/surface/flesh_shape.hpp"
#include "baker/mesh/surface/join_islands.hpp"

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
  std::vector<int> vertices = part_vertices(surface, parts, id), rim = rim_vertices(surface, parts, id);
  PartSurface view() const { return {character, surface, parts.part, id, vertices, rim}; }
};

// Hair, cloth and felt trail and settle in a swing or two, and are not shown further from their pose than a
// share of their radius that no one takes for rubber.
constexpr double kPieceDamping = 0.3, kPieceReach = 0.3;

// Of its radius, of a region that states none.
double usual_limit(const Region& region, const RegionRecipe& from) {
  if (region.is_piece) return kPieceReach;
  return from.side == BodySide::kAround ? Region{}.max_displacement
                                        : defaults_of(region.kind).max_displacement;
}

// What it moves like: as stated, else by its kind and size, or by the recipe's moduli.
void set_motion(const Recipe& recipe, const RegionRecipe* stated, Region& region) {
  const RegionRecipe fallback;
  const RegionRecipe& from = stated ? *stated : fallback;
  region.touches_body = from.touches_body;
  region.emulated = from.emulated.value_or(recipe.emulated);
  region.kind = kind_of_region(region.name, stated);
  region.is_piece = selects_piece(from);
  region.damping_ratio = from.damping_ratio.value_or(
      region.is_piece ? std::max(recipe.damping_ratio, kPieceDamping) : recipe.damping_ratio);
  region.intensity = from.intensity;
  const std::optional<double> most = from.max_displacement ? from.max_displacement : recipe.max_displacement;
  region.states_limit = most.has_value();
  region.max_displacement = most.value_or(usual_limit(region, from));
  region.states_frequency = from.frequency_hz.has_value();
  if (from.frequency_hz)
    region.frequency_hz = *from.frequency_hz;
  else if (!recipe.states_moduli)
    region.frequency_hz = default_frequency_hz(region.kind, 2 * region.radius_m);
}

// The region of these nodes; what it is called and moves like is the caller's to say.
Region& append_region(const Part& part, const std::vector<int>& nodes, const Edges& edges,
                      TissueLayout& layout) {
  const Character& character = part.character;
  Region region;
  region.frame_joint = frame_joint(character, part.rim, part.vertices);
  region.first_node = static_cast<int>(layout.nodes.size());
  region.node_count = static_cast<int>(nodes.size());
  region.vertices = carried_vertices(character, part.parts, part.id);
  const std::vector<Vector3> node_places = places(character, nodes);
  measure(node_places, region);
  region.carry = carry_weights(node_places, places(character, sample_rim(character, part.rim, kRimAnchors)),
                               places(character, region.vertices));
  carry_alike(part.surface, region.vertices, region.carry);
  for (const auto& [a, b] : edges) layout.edges.emplace_back(region.first_node + a, region.first_node + b);
  append_nodes(character, nodes, static_cast<int>(layout.regions.size()), layout);
  layout.regions.push_back(std::move(region));
  return layout.regions.back();
}

void append_finest(const Part& part, const Recipe& recipe, Evidence evidence, TissueLayout& layout) {
  std::vector<int> nodes = sample_nodes(part.view(), layout.stiffness, recipe.nodes_per_region);
  Edges edges = connect_nodes(part.view(), nodes, recipe.neighbours);
  order_for_cache(nodes, edges);
  const int owner = part.parts.region[static_cast<size_t>(part.id)];
  const RegionRecipe* stated =
      owner >= 0 ? &recipe.regions[static_cast<size_t>(owner)]
                 : stated_region(part.character, part.surface, recipe, layout.stiffness, part.vertices);
  Region& region = append_region(part, nodes, edges, layout);
  region.name = stated ? stated->name : region_name(part.character, layout.stiffness, part.vertices);
  region.evidence = evidence;
  region.recipe_region = owner;
  set_motion(recipe, stated, region);
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
  Region& coarser = append_region(part, nodes, connect_nodes(part.view(), nodes, recipe.neighbours), layout);
  Region same = region;  // all but the nodes
  same.first_node = coarser.first_node;
  same.node_count = coarser.node_count;
  same.carry = std::move(coarser.carry);
  coarser = std::move(same);
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

void join(const std::vector<bool>& other, std::vector<bool>& joints) {
  for (size_t j = 0; j < joints.size(); ++j) joints[j] = joints[j] || other[j];
}

// What of a piece is soft stays one part, though its islands meet only where they are held.
Links links_of_pieces(const Character& character, const Surface& surface, double rigid_stiffness,
                      const Stiffness& stiffness) {
  if (stiffness.piece.empty()) return {};
  std::vector<int> label = stiffness.piece;
  for (size_t v = 0; v < label.size(); ++v)
    if (stiffness.of_vertex[v] >= rigid_stiffness) label[v] = -1;
  return island_links(character, surface, label);
}

// Vertices that the recipe's regions name as pieces.
std::vector<bool> pieces_in(const Character& character, const Surface& surface, const Recipe& recipe) {
  const PieceRegions pieces(character, surface, recipe.regions);
  std::vector<bool> in(character.positions.size());
  for (size_t v = 0; v < in.size(); ++v) in[v] = pieces.claims(v);
  return in;
}

// Joints that hardly move anything but what a region of pieces has.
std::vector<bool> joints_of_pieces(const Character& character, const RegionScope& scope) {
  constexpr double kMostly = 0.8;  // of a joint's weight
  std::vector<double> own(scope.joints.size(), 0), all = own;
  for (size_t v = 0; v < character.skin.size(); ++v)
    for (size_t k = 0; k < kInfluences; ++k) {
      const auto j = static_cast<size_t>(character.skin[v].joint[k]);
      all[j] += character.skin[v].weight[k];
      if (scope.vertices[v]) own[j] += character.skin[v].weight[k];
    }
  std::vector<bool> joints(own.size());
  for (size_t j = 0; j < joints.size(); ++j)
    joints[j] = scope.joints[j] && own[j] > 0 && own[j] > kMostly * all[j];
  return joints;
}

// Joints whose flesh stronger evidence than springs and names has: regions of the recipe, and paint.
std::vector<bool> claimed_joints(const Character& character, const Surface& surface, const Recipe& recipe) {
  constexpr double kPainted = 0.2;  // of a joint's flesh, by weight
  std::vector<bool> claimed(character.joint_node.size(), false);
  for (const RegionRecipe& region : recipe.regions) {
    const RegionScope scope = scope_of(character, surface, region);
    join(selects_piece(region) ? joints_of_pieces(character, scope) : scope.joints, claimed);
  }
  if (character.stiffness.empty() || (recipe.states_regions && recipe.regions.empty())) return claimed;
  std::vector<double> soft(claimed.size(), 0), all(claimed.size(), 0);
  for (size_t v = 0; v < character.skin.size(); ++v)
    for (size_t k = 0; k < kInfluences; ++k) {
      const auto j = static_cast<size_t>(character.skin[v].joint[k]);
      all[j] += character.skin[v].weight[k];
      if (character.stiffness[v] < recipe.rigid_stiffness) soft[j] += character.skin[v].weight[k];
    }
  for (size_t j = 0; j < claimed.size(); ++j) claimed[j] = claimed[j] || soft[j] > kPainted * all[j];
  return claimed;
}

// Where rods move a bone that the region names, or what it names.
void refuse_on_rods(const Character& character, const RegionScope& scope, const std::vector<bool>& on_rods,
                    const std::string& where) {
  const bool names_bones = std::ranges::find(scope.joints, false) != scope.joints.end();
  std::vector<bool> joints = names_bones ? scope.joints : std::vector<bool>(scope.joints.size(), false);
  for (size_t v = 0; v < scope.vertices.size() && !names_bones; ++v)
    for (size_t k = 0; k < kInfluences && scope.vertices[v]; ++k)
      if (character.skin[v].weight[k] > 0) joints[static_cast<size_t>(character.skin[v].joint[k])] = true;
  for (size_t j = 0; j < joints.size(); ++j)
    if (joints[j] && on_rods[j])
      throw BadInput(where + "nothing is soft: rods move its bones; let '" + joint_name(character, j) +
                     "' be in one of them");
}

void refuse_close(const PieceRegions& pieces, size_t region, const std::string& where) {
  char text[240];
  std::snprintf(
      text, sizeof text,
      "nothing is soft: it sticks out of the soft tissue of its bones by %.0f %% of its extent, and "
      "pieces stay rigid below %.0f %%; name a piece that hangs free, or take it out",
      100 * pieces.share_out(region), 100 * kSticksOut);
  if (pieces.share_out(region) < kSticksOut) throw BadInput(where + text);
}

bool is_moved_by(const Influences& skin, const std::vector<bool>& joints) {
  for (size_t k = 0; k < kInfluences; ++k)
    if (skin.weight[k] > 0 && joints[static_cast<size_t>(skin.joint[k])]) return true;
  return false;
}

// Of a piece of which its region's bones move nothing.
void refuse_elsewhere(const Character& character, const RegionScope& scope, const std::string& where) {
  for (size_t v = 0; v < scope.vertices.size(); ++v)
    if (scope.vertices[v] && is_moved_by(character.skin[v], scope.joints)) return;
  throw BadInput(where + "its bones move nothing of the piece that it names; take its joints out");
}

// A region of the recipe is not left without a part in silence.
void check_all_found(const Character& character, const Surface& surface, const Recipe& recipe,
                     const SoftParts& parts, const std::vector<bool>& on_rods) {
  for (size_t r = 0; r < recipe.regions.size(); ++r) {
    if (std::ranges::find(parts.region, static_cast<int>(r)) != parts.region.end()) continue;
    const RegionRecipe& region = recipe.regions[r];
    const std::string where = character.name + ": recipe: region '" + region.name + "': ";
    if (region.stiffness >= recipe.rigid_stiffness)
      throw BadInput(where + "nothing is soft: its stiffness is not below rigid_stiffness; make it softer");
    const RegionScope scope = scope_of(character, surface, region);
    refuse_on_rods(character, scope, on_rods, where);
    if (selects_piece(region)) refuse_elsewhere(character, scope, where);
    if (selects_piece(region)) refuse_close(PieceRegions(character, surface, recipe.regions), r, where);
    throw BadInput(where +
                   "nothing is soft: its bones move fewer than four vertices enough; name bones that "
                   "move soft tissue, or take it out");
  }
}

// Nor is one of a painted character: where paint makes nothing of it soft, it is refused; where its flesh is
// part of another region's, that is noted.
void check_all_painted(Character& character, const Surface& surface, const Recipe& recipe,
                       const TissueLayout& layout, const std::vector<bool>& on_rods) {
  std::set<const RegionRecipe*> used;
  for (const Region& region : layout.regions)
    used.insert(stated_region(character, surface, recipe, layout.stiffness, region.vertices));
  for (const RegionRecipe& region : recipe.regions) {
    if (used.contains(&region)) continue;
    const std::string where = "recipe: region '" + region.name + "'";
    const RegionScope scope = scope_of(character, surface, region);
    bool soft = false;
    for (const Region& other : layout.regions)
      for (const int v : other.vertices)
        soft = soft || (scope.vertices[static_cast<size_t>(v)] &&
                        is_moved_by(character.skin[static_cast<size_t>(v)], scope.joints));
    if (!soft) refuse_on_rods(character, scope, on_rods, character.name + ": " + where + ": ");
    if (!soft)
      throw BadInput(
          character.name + ": " + where +
          ": nothing is soft: no part of four vertices or more that its bones move is painted below "
          "rigid_stiffness in the file's _STIFFNESS; paint one, or leave the attribute out");
    character.notes.push_back(where + " is not used: its painted vertices are part of other regions");
  }
}

// Names of the meshes that have a soft vertex on another piece's flesh.
std::string names_of_layers(const Character& character, const Surface& surface, const SoftParts& parts) {
  std::string names;
  for (const MeshSpan& mesh : character.meshes) {
    bool lies = false;
    for (size_t v = mesh.first_vertex; v < mesh.first_vertex + mesh.vertex_count; ++v)
      lies = lies || (surface.lies(v) && parts.part[static_cast<size_t>(character.welded[v])] >= 0);
    if (lies)
      names += (names.empty() ? "'" : ", '") + character.nodes[static_cast<size_t>(mesh.node)].name + "'";
  }
  return names;
}

void note_layers(Character& character, const Surface& surface, const SoftParts& parts, double reach_m) {
  const std::string names = names_of_layers(character, surface, parts);
  if (names.empty()) return;
  char reach[32];
  std::snprintf(reach, sizeof reach, "%.3g", reach_m);
  character.notes.push_back(names + ": what lies within " + reach +
                            " m of another piece's soft tissue moves with it; the recipe's layer_m states "
                            "the distance, 0 lets each move by itself");
}

// A stated side that nothing tells.
void note_sides(Character& character, const Recipe& recipe) {
  for (const RegionRecipe& region : recipe.regions)
    if (region.side && region.side != BodySide::kAround && !find_anatomy(character))
      character.notes.push_back("region '" + region.name +
                                "': its side is not used: no limbs in pairs show which side is the front");
}

void note_sheets(Character& character, const TissueLayout& layout) {
  for (const Region& region : layout.regions)
    if (region.evidence == Evidence::kRecipe && !region.is_piece &&
        thickness_share(character, region.vertices) < kThinSheet)
      character.notes.push_back(
          "region '" + region.name +
          "' is a thin sheet, which cells of tissue do not follow well: a chain of bones "
          "swings better, as one of the recipe's \"rods\"");
}

}  // namespace

TissueLayout layout_tissue(Character& character, const Recipe& recipe) {
  hold_roots(character, recipe);
  Surface surface = find_surface(character);
  const bool no_tissue = recipe.states_regions && recipe.regions.empty();
  const bool painted = !character.stiffness.empty() && !no_tissue;
  const bool states_regions = recipe.states_regions || !recipe.regions.empty();
  if (painted && states_regions)
    character.notes.push_back(
        "the file paints _STIFFNESS: the recipe's regions only name them and say how they move");

  TissueLayout layout;
  std::vector<bool> claimed = claimed_joints(character, surface, recipe);
  layout.rods = find_rods(character, recipe, claimed, &layout.skipped);
  join(joints_on_rods(character, layout.rods), claimed);
  NamedParts named = named_parts(character, surface, claimed,
                                 {.rods = !recipe.rods.has_value(),
                                  .regions = !painted && !states_regions,
                                  .has_region = pieces_in(character, surface, recipe)});
  add_named_rods(character, named.rods, layout.rods, layout.skipped);
  layout.found_rods = std::move(named.rods);
  std::ranges::move(named.skipped, std::back_inserter(layout.skipped));
  const std::vector<bool> on_rods = joints_on_rods(character, layout.rods);
  layout.proxies = find_proxies(character, find_bones(character, {}), on_rods, recipe);
  drop_crossed(character, layout.rods, recipe, layout.proxies);
  for (Rod& rod : layout.rods)
    if (rod.evidence == Evidence::kSpringBone && !character.colliders.empty())
      rod.passed_proxies = proxies_outside(layout.proxies, rod.collider_groups);

  Recipe as = recipe;
  if (!painted && !states_regions)
    for (const Candidate& found : named.regions) as.regions.push_back(found.region);
  layout.found_regions = named.regions;
  std::ranges::move(named.doubtful, std::back_inserter(layout.found_regions));
  layout.coreless = match_joints(character, recipe.coreless_joints, "recipe: coreless_joints");
  join(named.coreless, layout.coreless);
  join(flesh_joints(character), layout.coreless);
  Stiffness stiffness = painted ? painted_stiffness(character)
                                : stated_stiffness(character, surface, as.regions, layout.coreless);
  const double reach_m = recipe.layer_m.value_or(usual_layer_m(character));
  std::vector<bool> soft;
  for (const double of : stiffness.of_vertex) soft.push_back(of < as.rigid_stiffness);
  lay_on_flesh(character, find_overlaps(character, surface, soft, reach_m), as.rigid_stiffness, surface,
               stiffness);
  hold_on_rods(character, layout.rods, stiffness.of_vertex);
  const Surface joined =
      with_links(surface, links_of_pieces(character, surface, as.rigid_stiffness, stiffness));
  const SoftParts parts = find_soft_parts(character, joined, as.rigid_stiffness, stiffness);
  if (!painted && states_regions) check_all_found(character, surface, recipe, parts, on_rods);
  note_layers(character, surface, parts, reach_m);
  layout.stiffness = std::move(stiffness.of_vertex);
  layout.lies_on = surface.lies_on;
  const auto evidence_of = [&](int region) {
    if (painted) return Evidence::kPainted;
    return states_regions ? Evidence::kRecipe : named.regions[static_cast<size_t>(region)].evidence;
  };
  for (int id = 0; id < parts.count; ++id) {
    const Evidence evidence = evidence_of(parts.region[static_cast<size_t>(id)]);
    append_finest({character, joined, parts, id}, as, evidence, layout);
  }
  if (painted && states_regions) check_all_painted(character, surface, recipe, layout, on_rods);
  distinguish_names(layout.regions);
  note_sheets(character, layout);
  note_sides(character, recipe);
  fit_frequencies(character, layout);
  if (layout.regions.empty() && layout.rods.empty() && !no_tissue)
    character.notes.push_back(how_to_make_soft(character, layout.found_regions));
  return layout;
}

TissueLayout coarser_layout(const Character& character, const Recipe& recipe, const TissueLayout& finest,
                            const std::vector<int>& held, int nodes_per_region) {
  Surface surface = find_surface(character);
  link_layers(character, finest.lies_on, surface);
  SoftParts parts{
      std::vector<int>(character.positions.size(), -1), {}, static_cast<int>(finest.regions.size())};
  for (int id = 0; id < parts.count; ++id)
    for (const int v : finest.regions[static_cast<size_t>(id)].vertices)
      if (character.welded[static_cast<size_t>(v)] == v) parts.part[static_cast<size_t>(v)] = id;
  const Surface joined = with_links(surface, island_links(character, surface, parts.part));
  TissueLayout layout;
  layout.stiffness = finest.stiffness;
  layout.coreless = finest.coreless;
  layout.lies_on = finest.lies_on;
  for (int id = 0; id < parts.count; ++id)
    append_coarser({character, joined, parts, id}, recipe, finest, held[static_cast<size_t>(id)],
                   nodes_per_region, layout);
  return layout;
}

}  // namespace sinew::baker

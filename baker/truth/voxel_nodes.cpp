// voxel_nodes.cpp  see voxel_nodes.hpp.
#include "baker/truth/voxel_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/graph/carry.hpp"
#include "baker/mesh/graph/control_nodes.hpp"
#include "baker/truth/tissue_truth.hpp"

namespace sinew::baker {
namespace {

constexpr int kRimAnchors = 120;  // as the layout's

// Of each node of a cage that is free, the region whose control node is nearest; -1 of the others.
std::vector<int> regions_of(const Cage& cage, const TissueLayout& layout) {
  std::vector<int> regions(cage.nodes.size(), -1);
  for (size_t n = 0; n < regions.size(); ++n) {
    if (cage.constrained[n]) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const ControlNode& node : layout.nodes) {
      const double distance = (node.position - cage.nodes[n]).squaredNorm();
      if (distance < nearest) nearest = distance, regions[n] = node.region;
    }
  }
  return regions;
}

// Free corners of a part.
int free_corners(const Cage& cage, const TissueLayout& layout, int region) {
  return static_cast<int>(std::ranges::count(regions_of(cage, layout), region));
}

Recipe with_voxels(const Recipe& recipe, int voxels_high) {
  Recipe own = recipe;
  own.voxels_high = voxels_high;
  own.states_regions = false;  // of the others nothing need be free in it
  return own;
}

// The part of a character that is to stand on voxels.
struct Wanted {
  const Character& character;
  const TissueLayout& layout;
  const Recipe& recipe;
  int region;
  const std::string& name() const { return layout.regions[static_cast<size_t>(region)].name; }
};

// None where nothing of so coarse a cage is free.
int free_at(const Wanted& part, int voxels_high) {
  try {
    return free_corners(build_cage(part.character, part.layout, with_voxels(part.recipe, voxels_high)),
                        part.layout, part.region);
  } catch (const BadInput&) {
    return 0;
  }
}

// That leave it about as many free corners as are asked for.
int voxels_for(const Wanted& part) {
  constexpr int kFewest = 4, kMost = 160, kRounds = 7;
  constexpr double kNear = 0.15;  // logarithm
  int voxels = kUsualVoxelsHigh, best = 0;
  double least_off = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds && least_off > kNear; ++round) {
    const int free = free_at(part, voxels);
    const double ratio = 1.0 * part.recipe.nodes_per_region / std::max(free, 1);
    if (free > 0 && std::abs(std::log(ratio)) < least_off)
      best = voxels, least_off = std::abs(std::log(ratio));
    const int next = free == 0 ? 2 * voxels : static_cast<int>(std::lround(voxels * std::cbrt(ratio)));
    voxels = std::clamp(next != voxels ? next : voxels + (ratio < 1 ? -1 : 1), kFewest, kMost);
  }
  if (best == 0)
    throw BadInput(
        part.character.name + ": region '" + part.name() +
        "': voxels of no size leave it a free corner; state lower stiffness or core_share, or leave "
        "\"model\": \"deep_emulator\" out");
  return best;
}

// What of a cage a region stands on.
struct Corners {
  std::vector<int> nodes;  // of the cage, the free ones first
  size_t free = 0;
  std::vector<std::pair<int, int>> edges;  // of `nodes`
};

Corners corners_of(const Cage& cage, const std::vector<int>& region_of, int region) {
  Corners corners;
  std::set<int> free, held;
  for (size_t n = 0; n < region_of.size(); ++n)
    if (region_of[n] == region) free.insert(static_cast<int>(n));
  std::set<std::pair<int, int>> pairs;
  for (const auto& t : cage.tetrahedra) {
    if (std::ranges::none_of(t, [&](int n) { return free.contains(n); })) continue;
    for (const int a : t) {
      if (!free.contains(a)) held.insert(a);
      for (const int b : t)
        if (a < b) pairs.insert({a, b});
    }
  }
  corners.nodes.assign(free.begin(), free.end());
  corners.free = free.size();
  corners.nodes.insert(corners.nodes.end(), held.begin(), held.end());
  std::vector<int> place(cage.nodes.size(), -1);
  for (size_t k = 0; k < corners.nodes.size(); ++k)
    place[static_cast<size_t>(corners.nodes[k])] = static_cast<int>(k);
  for (const auto& [a, b] : pairs) {
    const auto [first, second] = std::minmax(place[static_cast<size_t>(a)], place[static_cast<size_t>(b)]);
    corners.edges.emplace_back(first, second);
  }
  return corners;
}

// Lumped to nodes: stiffness a mass of a full cell, and mass in full cells.
struct Matter {
  std::vector<double> stiffness_per_s2, mass;
};

Matter matter_of(const Cage& cage, double density_kg_m3) {
  Matter matter{std::vector<double>(cage.nodes.size()), std::vector<double>(cage.nodes.size())};
  const double cell = std::pow(cage.cell_m, 3), per_s2 = 1 / (density_kg_m3 * cage.cell_m * cage.cell_m);
  for (size_t e = 0; e < cage.tetrahedra.size(); ++e) {
    const auto corner = [&](size_t k) { return cage.nodes[static_cast<size_t>(cage.tetrahedra[e][k])]; };
    const double share =
        (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0)) / (24 * cell);
    for (const int n : cage.tetrahedra[e]) {
      matter.stiffness_per_s2[static_cast<size_t>(n)] += share * cage.young_pa[e] * per_s2;
      matter.mass[static_cast<size_t>(n)] += share * cage.fill[e];
    }
  }
  return matter;
}

int nearest_vertex(const Character& character, const Region& region, const Vector3& place) {
  return *std::ranges::min_element(region.vertices, {}, [&](int v) {
    return (character.positions[static_cast<size_t>(v)] - place).squaredNorm();
  });
}

// Vertices beside the region's.
std::vector<int> rim_of(const Character& character, const Region& region) {
  const auto same = [&](int v) { return character.welded[static_cast<size_t>(v)]; };
  std::set<int> own, rim;
  for (const int v : region.vertices) own.insert(same(v));
  for (const auto& triangle : character.triangles)
    if (std::ranges::any_of(triangle, [&](int v) { return own.contains(same(v)); }))
      for (const int v : triangle)
        if (!own.contains(same(v))) rim.insert(same(v));
  return {rim.begin(), rim.end()};
}

// Where it is, or where it lies on another piece.
Vector3 carried_place(const Character& character, const TissueLayout& layout, int vertex) {
  const auto v = static_cast<size_t>(vertex);
  if (layout.lies_on.empty() || layout.lies_on[v].empty()) return character.positions[v];
  Vector3 place = Vector3::Zero();
  for (const auto& [base, share] : layout.lies_on[v])
    place += share * character.positions[static_cast<size_t>(base)];
  return place;
}

std::vector<std::vector<double>> carry_of(const Character& character, const TissueLayout& layout,
                                          const Region& region, const std::vector<Vector3>& nodes) {
  std::vector<Vector3> anchors, places;
  for (const int v : sample_rim(character, rim_of(character, region), kRimAnchors))
    anchors.push_back(character.positions[static_cast<size_t>(v)]);
  for (const int v : region.vertices) places.push_back(carried_place(character, layout, v));
  return carry_weights(nodes, anchors, places);
}

// A part's cage, and what of it the part stands on.
struct Stand {
  Cage cage;
  Matter matter;
  Corners corners;
};

Stand make_stand(const Wanted& part) {
  Cage cage = TissueTruth(part.character, part.layout, with_voxels(part.recipe, voxels_for(part))).cage();
  Corners corners = corners_of(cage, regions_of(cage, part.layout), part.region);
  constexpr size_t kMostCorners = 4096;  // as a pack's region has nodes
  if (corners.nodes.size() > kMostCorners)
    throw BadInput(part.character.name + ": region '" + part.name() + "': its voxels have " +
                   std::to_string(corners.nodes.size()) + " corners, of which a pack holds " +
                   std::to_string(kMostCorners) + "; state fewer nodes_per_region");
  if (corners.free == corners.nodes.size())
    throw BadInput(part.character.name + ": region '" + part.name() +
                   "': none of its voxels' corners is held; leave \"model\": \"deep_emulator\" out");
  Matter matter = matter_of(cage, part.recipe.density_kg_m3);
  return {std::move(cage), std::move(matter), std::move(corners)};
}

void append_stand(const Wanted& part, const Stand& stand, TissueLayout& to) {
  const Character& character = part.character;
  const Cage& cage = stand.cage;
  const Region& was = part.layout.regions[static_cast<size_t>(part.region)];
  Region region = was;
  region.first_node = static_cast<int>(to.nodes.size());
  region.node_count = static_cast<int>(stand.corners.nodes.size());
  region.cell_m = cage.cell_m;
  std::vector<Vector3> places;
  for (size_t k = 0; k < stand.corners.nodes.size(); ++k) {
    const auto n = static_cast<size_t>(stand.corners.nodes[k]);
    places.push_back(cage.nodes[n]);
    const int vertex = nearest_vertex(character, was, places.back());
    ControlNode node{vertex,
                     part.region,
                     places.back(),
                     character.normals[static_cast<size_t>(vertex)],
                     cage.stiffness[n],
                     cage.skin[n]};
    node.corner = {.is_corner = true,
                   .is_held = k >= stand.corners.free,
                   .stiffness_per_s2 = stand.matter.stiffness_per_s2[n],
                   .mass = stand.matter.mass[n]};
    to.nodes.push_back(node);
  }
  region.carry = carry_of(character, part.layout, was, places);
  for (const auto& [a, b] : stand.corners.edges)
    to.edges.emplace_back(region.first_node + a, region.first_node + b);
  to.regions.push_back(std::move(region));
}

void append_as_it_was(const TissueLayout& before, int index, TissueLayout& to) {
  Region region = before.regions[static_cast<size_t>(index)];
  const int first = std::exchange(region.first_node, static_cast<int>(to.nodes.size()));
  for (const auto& [a, b] : before.edges)
    if (a >= first && a < first + region.node_count)
      to.edges.emplace_back(region.first_node + a - first, region.first_node + b - first);
  for (int n = first; n < first + region.node_count; ++n)
    to.nodes.push_back(before.nodes[static_cast<size_t>(n)]);
  to.regions.push_back(std::move(region));
}

// The layout with some of its regions on voxels.
TissueLayout standing(const Character& character, const Recipe& recipe, const TissueLayout& layout,
                      const std::map<int, Stand>& stands) {
  TissueLayout out = layout;
  out.skin_nodes = std::exchange(out.nodes, {});
  out.regions.clear(), out.edges.clear();
  for (int r = 0; r < static_cast<int>(layout.regions.size()); ++r)
    if (const auto stand = stands.find(r); stand != stands.end())
      append_stand({character, layout, recipe, r}, stand->second, out);
    else
      append_as_it_was(layout, r, out);
  return out;
}

std::string note_of(const Region& region, const Stand& stand) {
  char text[200];
  std::snprintf(text, sizeof text, "'%s' has its nodes on voxels of %.1f mm: %zu free corners, %zu held",
                region.name.c_str(), 1e3 * stand.cage.cell_m, stand.corners.free,
                stand.corners.nodes.size() - stand.corners.free);
  return text;
}

}  // namespace

TissueLayout layout_to_bake(Character& character, const Recipe& recipe) {
  TissueLayout layout = layout_tissue(character, recipe);
  std::map<int, Stand> stands;
  for (int r = 0; r < static_cast<int>(layout.regions.size()); ++r) {
    const Region& region = layout.regions[static_cast<size_t>(r)];
    if (!region.emulated) continue;
    const auto [stand, is_new] = stands.emplace(r, make_stand({character, layout, recipe, r}));
    character.notes.push_back(note_of(region, stand->second));
  }
  return stands.empty() ? layout : standing(character, recipe, layout, stands);
}

}  // namespace sinew::baker

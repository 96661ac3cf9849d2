// cage.cpp  A uniform voxel-tetrahedral cage around a surface: material, skin, and what is held by bones.
#include "baker/truth/cage/cage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/truth/cage/cage_fields.hpp"
#include "baker/truth/cage/cage_support.hpp"
#include "baker/truth/numerics/disjoint_sets.hpp"

namespace sinew::baker {
namespace {

constexpr int kFinePerCell = 3, kFinePerCellManyVoxels = 2, kManyVoxels = 80;

double longest_side(const Character& character) {
  Eigen::AlignedBox3d box;
  for (const Vector3& p : character.positions) box.extend(p);
  return box.isEmpty() ? 0 : box.sizes().maxCoeff();
}

// A vertex in no region is rigid, whatever its paint.
std::vector<double> effective_stiffness(const TissueLayout& layout) {
  std::vector<double> stiffness(layout.stiffness.size(), 1);
  for (const Region& region : layout.regions)
    for (const int v : region.vertices)
      stiffness[static_cast<size_t>(v)] = layout.stiffness[static_cast<size_t>(v)];
  return stiffness;
}

double distance_to_segment(const Vector3& p, const Vector3& from, const Vector3& to) {
  const Vector3 along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp(along.dot(p - from) / length2, 0.0, 1.0) : 0;
  return (p - from - share * along).norm();
}

// Metres to the nearest bone that moves this place and has a core; infinity without one.
double distance_to_core(const Bones& bones, const std::vector<bool>& coreless, const Influences& skin,
                        const Vector3& p) {
  constexpr double kMoves = 0.1;  // least share of skin weight
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < kInfluences; ++k) {
    const auto joint = static_cast<size_t>(skin.joint[k]);
    if (skin.weight[k] < kMoves || coreless[joint]) continue;
    nearest = std::min(nearest, distance_to_segment(p, bones.head[joint], bones.tail[joint]));
  }
  return nearest;
}

std::vector<bool> held_by_bones(const Character& character, const TissueLayout& layout, const Recipe& recipe,
                                const Cage& cage, const std::vector<double>& to_surface) {
  const Bones bones = find_bones(character, {});
  std::vector<bool> coreless = match_joints(character, recipe.coreless_joints, "recipe: coreless_joints");
  for (size_t j = 0; j < layout.coreless.size(); ++j) coreless[j] = coreless[j] || layout.coreless[j];
  std::vector<bool> held(cage.nodes.size());
  for (size_t i = 0; i < held.size(); ++i) {
    const double to_bone = distance_to_core(bones, coreless, cage.skin[i], cage.nodes[i]);
    const bool core = to_bone < recipe.core_share * (to_bone + to_surface[i]);
    held[i] = core || cage.stiffness[i] >= recipe.rigid_stiffness;
  }
  return held;
}

// Free nodes stay free in connected bodies that carry a region's vertex and hang on a constrained node.
void hold_useless_bodies(const TissueLayout& layout, Cage& cage) {
  DisjointSets bodies(cage.nodes.size());
  const auto free = [&](int node) { return !cage.constrained[static_cast<size_t>(node)]; };
  for (const auto& t : cage.tetrahedra)
    for (const int a : t)
      for (const int b : t)
        if (free(a) && free(b)) bodies.join(static_cast<size_t>(a), static_cast<size_t>(b));
  std::vector<bool> supported(cage.nodes.size()), seen(cage.nodes.size());
  const auto mark = [&](const std::array<int, 4>& t, std::vector<bool>& flags) {
    for (const int node : t)
      if (free(node)) flags[bodies.find(static_cast<size_t>(node))] = true;
  };
  for (const auto& t : cage.tetrahedra)
    if (!std::all_of(t.begin(), t.end(), free)) mark(t, supported);
  for (const Region& region : layout.regions)
    for (const int v : region.vertices)
      mark(cage.tetrahedra[static_cast<size_t>(cage.surface[static_cast<size_t>(v)].tetrahedron)], seen);
  for (size_t i = 0; i < cage.nodes.size(); ++i) {
    const size_t body = bodies.find(i);
    if (!supported[body] || !seen[body]) cage.constrained[i] = true;
  }
}

// A hinge's turn has no stiffness; the recurrence of such a mode would not stay.
void hold_hinged_parts(Cage& cage) {
  const std::vector<bool> hinged = hinged_nodes(cage.nodes, cage.tetrahedra, cage.constrained);
  for (size_t i = 0; i < hinged.size(); ++i)
    if (hinged[i]) cage.constrained[i] = true;
}

void set_material(const Recipe& recipe, Cage& cage) {
  for (size_t e = 0; e < cage.tetrahedra.size(); ++e) {
    double s = 0;
    for (const int node : cage.tetrahedra[e]) s += 0.25 * cage.stiffness[static_cast<size_t>(node)];
    cage.young_pa.push_back(cage.fill[e] * std::pow(recipe.young_soft_pa, 1 - s) *
                            std::pow(recipe.young_stiff_pa, s));
  }
}

std::vector<PlacedSample> placed_samples(const Character& character, const CageTopology& topology,
                                         double spacing) {
  std::vector<PlacedSample> placed;
  for (const SurfaceSample& sample : sample_surface(character, spacing))
    placed.push_back({sample, topology.place(sample.position, sample.inward)});
  return placed;
}

void check(const Character& character, const TissueLayout& layout, const Recipe& recipe) {
  if (character.triangles.empty() || !(longest_side(character) > 0))
    throw BadInput("cage: " + character.name + " has no surface: a cage needs triangles of some extent");
  if (layout.stiffness.size() != character.positions.size())
    throw BadInput("cage: the layout has " + std::to_string(layout.stiffness.size()) +
                   " vertices and the character " + std::to_string(character.positions.size()) +
                   ": lay out the tissue of this character");
  if (recipe.voxels_high && *recipe.voxels_high < 1)
    throw BadInput("cage: voxels_high is " + std::to_string(*recipe.voxels_high) + ": give 8 to 200");
}

// A vertex in the matter that it is of; one that lies on another piece in the matter beneath, at the place
// that it lies on.
Cage::Place place_of(const Character& character, const TissueLayout& layout, const CageTopology& topology,
                     size_t v) {
  if (layout.lies_on.empty() || layout.lies_on[v].empty())
    return topology.place(character.positions[v], -character.normals[v]);
  Vector3 place = Vector3::Zero(), normal = Vector3::Zero();
  for (const auto& [base, share] : layout.lies_on[v]) {
    place += share * character.positions[static_cast<size_t>(base)];
    normal += share * character.normals[static_cast<size_t>(base)];
  }
  return topology.place(place, -normal.normalized());
}

Cage build_cage(const Character& character, const TissueLayout& layout, const Recipe& recipe,
                int voxels_high) {
  Cage cage;
  cage.cell_m = longest_side(character) / voxels_high;
  const VoxelMatter matter(character, cage.cell_m,
                           voxels_high > kManyVoxels ? kFinePerCellManyVoxels : kFinePerCell);
  const CageTopology topology(matter);
  const std::vector<PlacedSample> samples = placed_samples(character, topology, 0.5 * cage.cell_m);
  CageFields fields = fit_fields(character, effective_stiffness(layout), topology, samples);
  for (size_t v = 0; v < character.positions.size(); ++v)
    cage.surface.push_back(place_of(character, layout, topology, v));
  cage.nodes = topology.nodes;
  cage.tetrahedra = topology.tetrahedra;
  cage.fill = topology.fill;
  cage.skin = std::move(fields.skin);
  cage.stiffness = std::move(fields.stiffness);
  cage.constrained = held_by_bones(character, layout, recipe, cage, surface_distance(topology, samples));
  hold_hinged_parts(cage);
  hold_useless_bodies(layout, cage);
  set_material(recipe, cage);
  return cage;
}

int free_nodes(const Cage& cage) {
  return static_cast<int>(std::count(cage.constrained.begin(), cage.constrained.end(), false));
}

Cage checked(Cage cage, const Character& character) {
  if (free_nodes(cage) == 0)
    throw BadInput("cage: " + character.name +
                   " has no free node: paint softer, lower the recipe's core_share, or raise voxels_high");
  return cage;
}

}  // namespace

Cage build_cage(const Character& character, const TissueLayout& layout, const Recipe& recipe) {
  check(character, layout, recipe);
  int voxels_high = recipe.voxels_high.value_or(kUsualVoxelsHigh);
  Cage cage = build_cage(character, layout, recipe, voxels_high);
  if (recipe.voxels_high) return checked(std::move(cage), character);
  const auto with_free_nodes = [&](int wanted) {
    return static_cast<int>(voxels_high * std::cbrt(1.0 * wanted / std::max(1, free_nodes(cage))));
  };
  while (free_nodes(cage) < kFewFreeNodes && voxels_high < kMostVoxelsHigh) {
    voxels_high = std::clamp(with_free_nodes(kFewFreeNodes), voxels_high + 1, kMostVoxelsHigh);
    cage = build_cage(character, layout, recipe, voxels_high);
  }
  const int finest = free_nodes(cage), finest_high = voxels_high;
  while (free_nodes(cage) > kMostFreeNodes) {
    voxels_high = std::min(voxels_high - 1, with_free_nodes(kMostFreeNodes));
    cage = build_cage(character, layout, recipe, voxels_high);
  }
  if (free_nodes(cage) < finest)
    cage.notes.push_back("much of it is soft: a cage of " + std::to_string(voxels_high) +
                         " voxels in the place of " + std::to_string(finest_high) + " (" +
                         std::to_string(free_nodes(cage)) + " free nodes, not " + std::to_string(finest) +
                         "); the recipe's voxels_high states how many");
  return checked(std::move(cage), character);
}

}  // namespace sinew::baker

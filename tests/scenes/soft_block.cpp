// soft_block.cpp  A synthetic character: a soft block on two joints, as a pack in memory.
#include "tests/scenes/soft_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <stdexcept>

#include "baker/import/character/character.hpp"
#include "baker/mesh/graph/leave_out.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "tests/scenes/block_modes.hpp"
#include "tests/scenes/block_network.hpp"

namespace sinew::scenes {
namespace {

using baker::Character;
using baker::Matrix4;
using baker::TissueLayout;
using baker::Vector3;

constexpr double kWidth_m = 0.3, kHeight_m = kBlockHeight_m, kJointHeight_m = 0.3;
constexpr double kSoftFrom_m = kBlockSoftFrom_m, kFullySoftFrom_m = 0.4;
constexpr size_t kNeighbours = 4;

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double softness(const Vector3& p) { return smooth_step(kSoftFrom_m, kFullySoftFrom_m, p.y()); }

// ---- mesh ------------------------------------------------------------------------------------------------

// A face spanned by u and v from its corner, outward normal u x v.
void add_face(const Vector3& corner, const Vector3& u, const Vector3& v, int cells_u, int cells_v,
              Character& to) {
  const int first = static_cast<int>(to.positions.size());
  for (int j = 0; j <= cells_v; ++j) {
    for (int i = 0; i <= cells_u; ++i) {
      to.positions.push_back(corner + u * i / cells_u + v * j / cells_v);
      to.normals.push_back(u.cross(v).normalized());
    }
  }
  for (int j = 0; j < cells_v; ++j) {
    for (int i = 0; i < cells_u; ++i) {
      const int a = first + j * (cells_u + 1) + i, b = a + cells_u + 1;
      to.triangles.push_back({a, a + 1, b});
      to.triangles.push_back({a + 1, b + 1, b});
    }
  }
}

void add_block(int cells, Character& to) {
  const double w = kWidth_m / 2;
  const Vector3 x(kWidth_m, 0, 0), y(0, kHeight_m, 0), z(0, 0, kWidth_m);
  add_face({-w, 0, w}, x, y, cells, 2 * cells, to);
  add_face({w, 0, -w}, -x, y, cells, 2 * cells, to);
  add_face({w, 0, w}, -z, y, cells, 2 * cells, to);
  add_face({-w, 0, -w}, z, y, cells, 2 * cells, to);
  add_face({-w, kHeight_m, w}, x, -z, cells, cells, to);
  add_face({-w, 0, -w}, x, z, cells, cells, to);
}

void weld(Character& character) {
  constexpr double kSamePlace_m = 1e-9;
  for (const Vector3& p : character.positions) {
    const auto same = std::ranges::find_if(character.positions,
                                           [&](const Vector3& q) { return (p - q).norm() < kSamePlace_m; });
    character.welded.push_back(static_cast<int>(same - character.positions.begin()));
  }
}

baker::Influences influences_at(const Vector3& p) {
  const double upper = smooth_step(0.15, 0.45, p.y());
  const bool first = upper < 0.5;
  baker::Influences skin;
  skin.joint = {first ? 0 : 1, first ? 1 : 0};
  skin.weight = {first ? 1 - upper : upper, first ? upper : 1 - upper};
  return skin;
}

void add_joints(Character& character) {
  for (int j = 0; j < 2; ++j) {
    baker::Node node;
    node.name = j == 0 ? "foot" : "waist";
    node.parent = j - 1;
    node.translation = Vector3(0, j * kJointHeight_m, 0);
    character.nodes.push_back(node);
    character.joint_node.push_back(j);
    character.joint_parent.push_back(j - 1);
    Matrix4 inverse_bind = Matrix4::Identity();
    inverse_bind(1, 3) = -j * kJointHeight_m;
    character.inverse_bind.push_back(inverse_bind);
  }
}

void add_clip(Character& character) {
  const double half_rad = 0.5;
  const baker::Channel turn{.node = 1,
                            .path = baker::Path::kRotation,
                            .times_s = {0, 1},
                            .values = {0, 0, 0, 1, 0, 0, std::sin(half_rad), std::cos(half_rad)}};
  character.clips.push_back({.name = "nod", .duration_s = 1, .channels = {turn}});
}

void add_tangents(Character& character) {
  for (size_t v = 0; v < character.positions.size(); ++v)
    character.tangents.push_back(
        {character.normals[v].unitOrthogonal(), character.positions[v].x() < 0 ? -1.0 : 1.0});
}

Character block_character(const BlockOptions& options) {
  Character character;
  character.name = options.name;
  add_joints(character);
  add_block(options.cells, character);
  weld(character);
  for (const Vector3& p : character.positions) {
    character.skin.push_back(influences_at(p));
    character.colors.push_back({220, 160, 140, 255});
    character.stiffness.push_back(1 - softness(p));
  }
  if (options.clip) add_clip(character);
  if (options.tangents) add_tangents(character);
  return character;
}

// ---- tissue ----------------------------------------------------------------------------------------------

std::vector<int> soft_vertices(const Character& character, int region, int regions) {
  std::vector<int> vertices;
  for (size_t v = 0; v < character.positions.size(); ++v) {
    const Vector3& p = character.positions[v];
    const int side = regions == 1 || p.x() < 0 ? 0 : 1;
    if (side == region && softness(p) > 0) vertices.push_back(static_cast<int>(v));
  }
  return vertices;
}

const Vector3& place(const Character& character, int vertex) {
  return character.positions[static_cast<size_t>(vertex)];
}

double distance_to_chosen(const Character& character, const std::vector<int>& chosen, int vertex) {
  double nearest = 1e9;
  for (int other : chosen) {
    nearest = std::min(nearest, (place(character, vertex) - place(character, other)).norm());
  }
  return nearest;
}

// Farthest-point sampling among the softest.
std::vector<int> sample_nodes(const Character& character, const std::vector<int>& vertices, int count) {
  constexpr double kSoftEnough = 0.3;
  std::vector<int> candidates, chosen;
  std::ranges::copy_if(vertices, std::back_inserter(candidates),
                       [&](int v) { return softness(place(character, v)) > kSoftEnough; });
  while (static_cast<int>(chosen.size()) < count) {
    chosen.push_back(*std::ranges::max_element(
        candidates, {}, [&](int v) { return distance_to_chosen(character, chosen, v); }));
  }
  return chosen;
}

// Shares that fall with the distance to each node, times softness, so that the rim stays.
std::vector<std::vector<double>> carry_weights(const Character& character, const std::vector<int>& nodes,
                                               const std::vector<int>& vertices) {
  constexpr double kReach_m = 0.08;
  std::vector<std::vector<double>> carry(nodes.size(), std::vector<double>(vertices.size()));
  for (size_t v = 0; v < vertices.size(); ++v) {
    double sum = 0;
    for (size_t n = 0; n < nodes.size(); ++n) {
      const double d = (place(character, nodes[n]) - place(character, vertices[v])).norm() / kReach_m;
      sum += carry[n][v] = std::exp(-d * d) + 1e-6;
    }
    for (size_t n = 0; n < nodes.size(); ++n) carry[n][v] *= softness(place(character, vertices[v])) / sum;
  }
  return carry;
}

void connect(const TissueLayout& layout, const baker::Region& region, std::set<std::pair<int, int>>& edges) {
  const int end = region.first_node + region.node_count;
  const auto node = [&](int n) { return layout.nodes[static_cast<size_t>(n)].position; };
  for (int a = region.first_node; a < end; ++a) {
    std::vector<int> others;
    for (int b = region.first_node; b < end; ++b) {
      if (b != a) others.push_back(b);
    }
    std::ranges::sort(others, {}, [&](int b) { return (node(a) - node(b)).norm(); });
    for (size_t k = 0; k < std::min(kNeighbours, others.size()); ++k) edges.insert(std::minmax(a, others[k]));
  }
}

void add_region(const Character& character, const BlockOptions& options, int index, TissueLayout& layout) {
  baker::Region region;
  region.name = index == 0 ? "left" : "right";
  region.first_node = static_cast<int>(layout.nodes.size());
  region.node_count = options.nodes;
  region.touches_body = options.arms && options.arms->touches_body;
  region.max_displacement = options.displacement_limit;
  region.vertices = soft_vertices(character, index, options.regions);
  const std::vector<int> nodes = sample_nodes(character, region.vertices, options.nodes);
  region.carry = carry_weights(character, nodes, region.vertices);
  for (int v : nodes) {
    const auto at = static_cast<size_t>(v);
    layout.nodes.push_back({.vertex = v,
                            .region = index,
                            .position = character.positions[at],
                            .normal = character.normals[at],
                            .stiffness = character.stiffness[at],
                            .skin = character.skin[at]});
    region.center += character.positions[at] / options.nodes;
  }
  for (int v : nodes)
    region.radius_m = std::max(region.radius_m, (place(character, v) - region.center).norm());
  layout.regions.push_back(region);
}

TissueLayout block_tissue(const Character& character, const BlockOptions& options) {
  TissueLayout layout;
  layout.stiffness = character.stiffness;
  std::set<std::pair<int, int>> edges;
  for (int r = 0; r < options.regions; ++r) {
    add_region(character, options, r, layout);
    connect(layout, layout.regions.back(), edges);
  }
  layout.edges.assign(edges.begin(), edges.end());
  return layout;
}

// Farthest points first: a coarser graph's nodes are the finest's first, node 0, where regions are held, too.
std::vector<baker::GraphLevel> coarser_levels(const Character& character, const BlockOptions& options,
                                              const TissueLayout& finest) {
  std::vector<baker::GraphLevel> levels;
  for (const int nodes : options.coarser_nodes) {
    BlockOptions coarser = options;
    coarser.nodes = nodes;
    TissueLayout layout = block_tissue(character, coarser);
    for (size_t r = 0; r < layout.regions.size(); ++r) {
      layout.regions[r].center = finest.regions[r].center;
      layout.regions[r].radius_m = finest.regions[r].radius_m;
    }
    levels.push_back({layout, block_modes(layout, &finest)});
  }
  if (options.leaves_out) {
    const TissueLayout last = levels.empty() ? finest : levels.back().layout;
    const TissueLayout layout = baker::leave_out(last, {"left"}, "soft_block");
    levels.push_back({layout, block_modes(layout, &finest)});
  }
  return levels;
}

// Nodes in the lower third are held.
void stand_on_corners(TissueLayout& layout) {
  baker::Region& region = layout.regions[0];
  region.emulated = true;
  region.cell_m = 0.05;
  const auto begin = layout.nodes.begin() + region.first_node, end = begin + region.node_count;
  std::vector<double> heights;
  for (auto node = begin; node != end; ++node) heights.push_back(node->position.y());
  std::ranges::sort(heights);
  for (auto node = begin; node != end; ++node)
    node->corner = {.is_corner = true,
                    .is_held = node->position.y() <= heights[heights.size() / 3],
                    .stiffness_per_s2 = 7200,
                    .mass = 1};
}

// What a load moves it by grows with the square.
void slow_down(double share, baker::ModalBasis& basis) {
  basis.rad_per_s *= share;
  basis.rest_rad_per_s *= share;
  basis.first_rad_per_s *= share;
  basis.rest /= share * share;
}

}  // namespace

PackBytes::PackBytes(const std::byte* data, size_t size) : memory_(size), size_(size) {
  if (!memory_.data()) throw std::bad_alloc();
  std::memcpy(memory_.data(), data, size);
}

PackBytes soft_block(const BlockOptions& options) {
  Character character = block_character(options);
  TissueLayout layout = block_tissue(character, options);
  const std::vector<baker::GraphLevel> coarser = coarser_levels(character, options, layout);
  if (options.rods) add_rods(*options.rods, character, layout);
  if (options.arms) add_arms(*options.arms, character, layout);
  if (options.emulator) stand_on_corners(layout);
  const baker::Safetensors weights = options.weights ? *options.weights : block_network(options);
  std::vector<baker::ModalBasis> modes = block_modes(layout);
  for (baker::ModalBasis& basis : modes) slow_down(options.frequency_share, basis);
  const std::vector<std::byte> bytes =
      baker::pack_character(character, layout, modes, options.network ? &weights : nullptr, coarser,
                            options.rod_weights, options.emulator);
  return PackBytes(bytes.data(), bytes.size());
}

}  // namespace sinew::scenes

// recipe.hpp  What an artist states about a character's tissue; every key of the JSON file is optional.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "baker/mesh/anatomy/body_side.hpp"
#include "baker/mesh/anatomy/soft_kind.hpp"
#include "baker/mesh/recipe/rod_recipe.hpp"

namespace sinew::baker {

// A soft part by its bones, or a piece of the surface; of what it names of both, what all have in common. On
// bones softness grows with their skin weight and with the flesh over them (bones without a rigid core: with
// the weight alone); a piece is held at the body and softest where it sticks out furthest
// (piece_softness.hpp). Where two regions meet, the skin between them stays rigid.
struct RegionRecipe {
  std::string name;
  std::vector<std::string> joints = {};  // names or prefix*
  double stiffness = 0.1;                // 0 soft .. 1 rigid at its softest point
  bool touches_body = false;  // the capsules about the character's bones, but for those that carry it
  // "model": "deep_emulator" (true) or "alt_conv_lstm"; absent: Recipe::emulated.
  std::optional<bool> emulated = {};
  // What the default frequency goes by; absent: what its name says, then its bones'.
  std::optional<SoftKind> kind = {};
  std::optional<BodySide> side = {};  // of its bones, on which it is soft; absent: its kind's (body_side.hpp)
  std::optional<double> frequency_hz = {};  // 0.05 .. 25, of its first mode; absent: see Recipe
  std::optional<double> damping_ratio =
      {};                // 0 .. 0.95; absent: Recipe::damping_ratio, of a piece 0.3 at least
  double intensity = 1;  // 0 none .. 1 physical .. 2: scales its displacement
  std::optional<double> max_displacement = {};  // of its radius, 0.01 .. 4; absent: Recipe::max_displacement
  std::string mesh = {}, material = {};         // name or prefix*; a mesh's own or its node's
  std::optional<Eigen::Vector3d> island_at = {};  // m, bind pose: the connected piece that is nearest to it
};

// Of a capsule that rods and regions collide with, its bone by name or prefix*.
struct ProxyRecipe {
  std::string joint;
  double radius_m = 0;  // 1e-3 .. 10
};

inline constexpr int kUsualVoxelsHigh = 36;

struct Recipe {
  // Tissue material. Stiffness s maps to Young's modulus soft^(1-s) stiff^s. Where a recipe states a modulus,
  // regions without a frequency of their own have it as it is; else each region's moduli are scaled so that
  // its first mode has its frequency.
  bool states_moduli = false;
  double young_soft_pa = 6e3;   // > 0
  double young_stiff_pa = 1e5;  // >= young_soft_pa
  double poisson_ratio = 0.42;  // 0 .. 0.49
  double density_kg_m3 = 1000;  // > 0
  double damping_ratio = 0.1;   // 0 .. 1, Rayleigh, at the first and third mode's neighbourhood
  // 0.01 .. 4, share of a region's radius, approached smoothly. Absent: its kind's (soft_kind.hpp), or
  // less, as far as its skin can stretch.
  std::optional<double> max_displacement = {};
  // 8 .. 200, cage cells along the character's longest side; absent: kUsualVoxelsHigh, or by how much is
  // soft (truth/cage/cage.hpp)
  std::optional<int> voxels_high;
  double rigid_stiffness = 0.95;  // painted stiffness from here on is constrained to the skinning
  double core_share = 0.45;       // 0 .. 1, share of the way from bone to skin that follows the bone rigidly
  std::vector<std::string> coreless_joints;  // names or prefix*: bones without a rigid core (ears, tails)

  bool emulated =
      false;  // "model": "deep_emulator"; of an emulated region nodes_per_region counts free corners

  // Control graph.
  // Nodes a region: of the finest graph (4 .. 4096; more than a region has vertices: a node on each), and of
  // up to three coarser ones beside it, each fewer, from 4 on. A recipe that states the first alone has no
  // others.
  int nodes_per_region = 80;
  std::vector<int> coarser_nodes = {40, 20};
  // Regions by name or prefix*: one graph more, the last of the above without them. Beside two coarser ones
  // at most.
  std::vector<std::string> left_out;
  int neighbours = 6;  // 2 .. 16
  // 0 .. 10: what lies as near to another piece's soft flesh moves with it, 0: nothing does. Absent: as
  // kLayerShare says (layers.hpp).
  std::optional<double> layer_m = {};
  double unit_m = 0;  // see ImportOptions
  char up = 'y';
  std::optional<std::vector<RodRecipe>> rods;  // absent: from the file's spring bones, where it has any
  std::vector<ProxyRecipe> proxies;            // radii that take the place of fitted ones
  std::vector<std::string> without_proxies;    // names or prefix*: bones that get no capsule
  std::vector<RegionRecipe> regions;
  bool states_regions =
      false;  // an empty list too: nothing is soft. Else: by what the file and its names show
  // Meshes of the file that are not imported, by name or prefix*.
  std::vector<std::string> without_meshes;
  // Of lesser levels of detail and invisible meshes, which are not imported unless they are named here.
  std::vector<std::string> with_meshes;
};

// A region or rod of which "enabled" is false is read and checked, and is as if it were not there; "note" is
// for its reader. Throws BadInput: not JSON, an unknown key (named, with the nearest known one), a number
// outside its range.
Recipe read_recipe(const std::string& path);

}  // namespace sinew::baker

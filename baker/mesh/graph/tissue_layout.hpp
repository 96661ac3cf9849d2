// tissue_layout.hpp  Which parts of a character are soft, the control graph that stands for them, and which
// bones are rods.
#pragma once
#include <utility>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/candidate.hpp"
#include "baker/mesh/recipe/evidence.hpp"
#include "baker/mesh/recipe/recipe.hpp"
#include "baker/mesh/rods/proxies.hpp"
#include "baker/mesh/rods/rods.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

struct ControlNode {
  int vertex = 0;  // the (welded) surface vertex it stands on
  int region = 0;
  Vector3 position, normal;  // bind pose
  double stiffness = 0;
  Influences skin;
  // Of an emulated region, whose nodes are corners of voxels: `vertex` is then the nearest that it carries.
  struct Corner {
    bool is_corner = false;       // else it stands on its vertex
    bool is_held = false;         // follows its pose
    double stiffness_per_s2 = 0;  // of its share of its tetrahedra, a full cell's mass
    double mass = 0;              // in full cells' masses
  } corner = {};
};

struct Region {
  std::string name;
  int frame_joint = 0;  // the joint with the most skin weight where the region meets rigid flesh
  int first_node = 0, node_count = 0;
  std::vector<int> vertices;  // ascending; all file vertices carried, duplicates at seams included
  std::vector<std::vector<double>>
      carry;  // [node in region][vertex in region]; zero displacement at the rigid rim
  Vector3 center = Vector3::Zero();
  double radius_m = 0;
  bool touches_body = false;  // RegionRecipe::touches_body
  bool emulated = false;      // RegionRecipe::emulated: a network of patches predicts it
  double cell_m = 0;          // of its voxels, where it stands on them (truth/voxel_nodes.hpp)
  Evidence evidence = Evidence::kRecipe;
  SoftKind kind = SoftKind::kOther;
  int recipe_region = -1;         // of the recipe's, or of found_regions; -1: of paint
  bool is_piece = false;          // of surface that the region names, and not flesh over bones
  double frequency_hz = 0;        // what its first mode is to have; 0: what its moduli give
  bool states_frequency = false;  // it is the recipe's
  double damping_ratio = 0.1;
  double intensity = 1;
  double max_displacement = 0.35;  // share of radius_m
  bool states_limit = false;       // it is the recipe's
};

struct TissueLayout {
  std::vector<double> stiffness;  // a vertex: painted, or as the recipe's or named bones' regions state it
  std::vector<bool> coreless;     // a joint: no rigid core about its bone
  std::vector<LiesOn> lies_on;    // a vertex, as of Surface
  std::vector<Region> regions;
  std::vector<ControlNode> nodes;          // region after region
  std::vector<ControlNode> skin_nodes;     // those before parts stood on voxels (truth/voxel_nodes.hpp)
  std::vector<std::pair<int, int>> edges;  // undirected, no self-loops, each region connected
  std::vector<Proxy> proxies;              // what rods and regions collide with
  std::vector<Rod> rods;                   // what hangs on their bones is not soft: the rods move it
  std::vector<SkippedPart> skipped;        // evidence that came to nothing
  // Where no recipe states regions or rods: what was found, the doubtful, which stays rigid, last.
  std::vector<Candidate> found_regions;
  std::vector<RodRecipe> found_rods;  // by names
};

// The nodes on the skin, by which flesh belongs to regions whatever the regions stand on.
inline const std::vector<ControlNode>& nodes_on_skin(const TissueLayout& layout) {
  return layout.skin_nodes.empty() ? layout.nodes : layout.skin_nodes;
}

// Parts by evidence: what the recipe states, what is painted, the file's spring bones, bone names, names of
// meshes and materials, shape. A bone is used once, by the strongest. A character of which nothing swings has
// no regions and no rods, and a note that says how to change that.
//
// Throws BadInput as find_rods does, and: a recipe's joint that does not exist (named), a region of the
// recipe that leaves nothing soft.
TissueLayout layout_tissue(Character& character, const Recipe& recipe);

// The same soft parts under fewer control nodes: the first that layout_tissue chose in each region, and the
// one that it is held at, for a region's nodes are told against that one at every level. Regions keep their
// centre and radius. held: of each region of `finest`, its vertex. Rods and proxies are left out.
TissueLayout coarser_layout(const Character& character, const Recipe& recipe, const TissueLayout& finest,
                            const std::vector<int>& held, int nodes_per_region);

}  // namespace sinew::baker

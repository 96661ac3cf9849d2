// regions.hpp  Soft parts of the surface: which vertices, whose frame, what name.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/recipe/recipe.hpp"
#include "baker/mesh/regions/stiffness.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

// As stated, else by its name, else by its bones'.
SoftKind kind_of_region(const std::string& name, const RegionRecipe* stated);

struct SoftParts {
  std::vector<int> part;    // welded vertex -> part, -1: rigid
  std::vector<int> region;  // of each part, whose it is (Stiffness::region); -1: painted
  int count = 0;
};

// Connected parts of vertices below rigid_stiffness. Parts of fewer than four welded vertices become rigid
// (stiffness is changed), with a note; so do, of a region that names bones, those that are small beside its
// largest one.
SoftParts find_soft_parts(Character& character, const Surface& surface, double rigid_stiffness,
                          Stiffness& stiffness);

// Welded vertices of a part that lie on no other piece, ascending.
std::vector<int> part_vertices(const Surface& surface, const SoftParts& parts, int id);

// Rigid vertices that the part touches, ascending.
std::vector<int> rim_vertices(const Surface& surface, const SoftParts& parts, int id);

// The joint with the most skin weight on the rim; of the whole part where it has no rim.
int frame_joint(const Character& character, const std::vector<int>& rim, const std::vector<int>& vertices);

// Of painted parts, the recipe's region that has most of the part's weight where it is soft; null: none has.
const RegionRecipe* stated_region(const Character& character, const Surface& surface, const Recipe& recipe,
                                  const std::vector<double>& stiffness, const std::vector<int>& vertices);

// Of the joint that has most of that weight.
std::string region_name(const Character& character, const std::vector<double>& stiffness,
                        const std::vector<int>& vertices);

// Makes names unlike each other: a pair gets _l and _r (left is +X, characters face +Z), others are numbered.
void distinguish_names(std::vector<Region>& regions);

}  // namespace sinew::baker

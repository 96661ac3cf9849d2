// bone_pieces.hpp  Pieces of surface that hang on one bone and stick out of the body: hair, hats, capes,
// fins.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/evidence.hpp"
#include "baker/mesh/recipe/recipe.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

struct BonePiece {
  RegionRecipe region;                      // as an artist would state it
  int joint = 0;                            // that it hangs on
  std::vector<int> vertices;                // ascending
  bool is_named = false;                    // its mesh's, node's or material's name says that it is soft
  Evidence evidence = Evidence::kMeshName;  // of one that is named
  std::string why;                          // it is thought of: "mesh 'Cape' hangs on one bone, 'chest'"
  std::string doubt;                        // why it may not be soft for all that; empty: it is certain
};

// One for each name and bone, in the order of their vertices.
std::vector<BonePiece> named_pieces(const Character& character, const Surface& surface);

// Those, and then, of what no name calls hard, what sticks out far, the largest of it. Geometry says where a
// piece is, not of what it is made: without a name it is doubtful.
std::vector<BonePiece> bone_pieces(const Character& character, const Surface& surface);

}  // namespace sinew::baker

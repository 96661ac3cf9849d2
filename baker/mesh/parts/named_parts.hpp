// named_parts.hpp  The soft parts and rods that names point at, as an artist's recipe would state them.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/candidate.hpp"
#include "baker/mesh/recipe/evidence.hpp"
#include "baker/mesh/recipe/recipe.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

struct NamedParts {
  std::vector<RodRecipe> rods;
  std::vector<Candidate> regions;   // without a doubt
  std::vector<Candidate> doubtful;  // that stay rigid unless a recipe takes them up
  std::vector<bool> coreless;       // a joint: its bone lies in the region's flesh, which moves as a whole
  std::vector<SkippedPart> skipped;
};

struct NamedPartsWanted {
  bool rods = true, regions = true;
  std::vector<bool> has_region = {};  // vertices of pieces that the recipe names; empty: of none
};

// Never of what a joint of `claimed` moves, of a bone on which a limb or the head hangs (but for a belly with
// thick flesh), of what only helps the rig, and of what would be too small to be seen. Two bones in a row, or
// one with an end site, become a rod where their kind swings as a chain; flesh becomes a region; sheets
// and shells stay rigid and are listed with what would let them swing. So are pieces that are fastened to one
// bone, but for those of which mesh or material say that they are soft and which stick out (bone_pieces.hpp):
// these are regions.
NamedParts named_parts(const Character& character, const Surface& surface, const std::vector<bool>& claimed,
                       NamedPartsWanted wanted);

// Joints that riggers add to move flesh, by name: they have no bone of their own.
std::vector<bool> flesh_joints(const Character& character);

// For a character with nothing that swings: how to say what should, with the bones that have most flesh.
std::string how_to_make_soft(const Character& character, const std::vector<Candidate>& doubtful);

}  // namespace sinew::baker

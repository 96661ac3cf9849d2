// proposal.hpp  All that may swing of a character as a recipe to edit: what is certain, and what is in doubt.
#pragma once
#include <string>
#include <vector>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/recipe/candidate.hpp"
#include "baker/mesh/recipe/rod_recipe.hpp"

namespace sinew::baker {

struct ProposedRod {
  RodRecipe rod;
  std::string why;
};

struct Proposal {
  std::vector<Candidate> regions;  // certain ones, then those in doubt
  std::vector<ProposedRod> rods;
};

// Of the layout of a character without a recipe, with the frequencies and limits that it has by now. Of paint
// regions name what the layout found.
Proposal propose(const Character& character, const TissueLayout& layout);

// The recipe that states these regions and rods alone.
Recipe recipe_of(const std::vector<Candidate>& regions, const std::vector<ProposedRod>& rods);

// Frequency and limit of a region as the layout of a recipe has it, of which it is number `index`: of several
// parts the stiffest and the least.
void state_numbers(const TissueLayout& layout, int index, RegionRecipe& region);

// The recipe as JSON: what is in doubt is not enabled, and notes number the parts from 1 and say why.
// read_by: how the file is read (unit_m, up, meshes) goes along.
std::string proposal_text(const Proposal& proposal, const Recipe& read_by, const std::string& file);

}  // namespace sinew::baker

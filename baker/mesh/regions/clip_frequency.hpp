// clip_frequency.hpp  How soft flesh may be for the clips that shake it.
#pragma once
#include "baker/import/character/character.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"

namespace sinew::baker {

// Raises a default frequency until flesh that swings at it stands at its region's limit in at most a tenth of
// the ticks of the character's clips, and notes it: softer flesh would lie at the limit and no longer swing.
// A frequency that a recipe states is kept, with a note that names the one that would do. Regions of stated
// moduli are left alone. Of each clip its first four seconds count, repeated until flesh swings with them.
// The limit is the layout's: a bake may lower it afterwards, where skin would tear.
void fit_frequencies(Character& character, TissueLayout& layout);

}  // namespace sinew::baker

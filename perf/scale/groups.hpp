// groups.hpp  The tables of perf/scale, each written by its own file.
#pragma once
#include <vector>

#include "samples/demo/character_file.hpp"

namespace sinew::perf {

// Where a tick of one character goes, each part against the multiply-add peak of the same process.
void measure_parts(const demo::CharacterFile& character, int rounds);
// One to 500 instances, on one and on two workers.
void measure_crowds(const demo::CharacterFile& character, int rounds);
// One instance of each character, ascending in vertices.
void measure_vertices(const std::vector<demo::CharacterFile>& characters, int rounds);
// Regions that sleep: what is left out of clips, and what that adds to the surface.
void measure_sleep(const demo::CharacterFile& character);
// Instances' control graphs as one block-diagonal graph, against one network step each.
void measure_batches(const demo::CharacterFile& character, int rounds);

}  // namespace sinew::perf

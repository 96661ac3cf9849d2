// pick_clips.hpp  Which of a character's clips stand for all of them.
#pragma once
#include <cstddef>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// Places in character.clips, ascending: of those in which joints move, the first, the last and what lies
// evenly between, `most` at most.
std::vector<size_t> pick_clips(const Character& character, size_t most);

}  // namespace sinew::baker

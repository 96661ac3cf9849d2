// truths.hpp  Ground truth of a character's own clips, simulated once and kept.
#pragma once
#include <string>
#include <vector>

#include "baker/trade/source/baked_from.hpp"
#include "pack/reader.hpp"

namespace sinew::baker {

// Each clip as it is, then at another speed and from another start (motion.hpp), at the character's rate, on
// all cores. Those of these clips, seconds, source and recipe that lie in the folder already are taken as
// they are; where it holds only others, one line on standard error says so. Throws BadInput: no such clip, no
// clips, another character's source.
std::vector<std::string> simulate_clips(const BakedFrom& source, const std::vector<std::string>& clips,
                                        double seconds, const pack::PackView& character,
                                        const std::string& folder);

}  // namespace sinew::baker

// trained_rods.hpp  Which rods a COPINGNet learned from, and which of a character's are none of them.
#pragma once
#include <string>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "pack/reader.hpp"

namespace sinew::baker {

// A note for each rod that starts by the network (all of them where no recipe says so) and has fewer or more
// segments, what holds it counted in, or stiffer or softer joints in its own units than the rods that
// `weights` were trained on: there its corrections are a guess, and the solver pays for them. Metadata:
// trained.segments and trained.log_compliances, each "least,most"; without them nothing is known, and one
// note says so. Throws BadInput where either is no pair of numbers.
std::vector<std::string> notes_of_untrained_rods(const Safetensors& weights, const pack::PackView& pack);

}  // namespace sinew::baker

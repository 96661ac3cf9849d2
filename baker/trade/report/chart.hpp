// chart.hpp  The front as a picture: what a step costs, logarithmic, against what of skinning's error is
// left.
#pragma once
#include <string>

#include "baker/trade/report/table.hpp"

namespace sinew::baker {

// stem.svg and stem.png. Throws BadInput when they cannot be written.
void write_chart(const std::string& stem, const Measured& measured);

}  // namespace sinew::baker

// error_chart.hpp  Mean error over time, skinning against Sinew, as a panel of the film.
#pragma once
#include <vector>

#include "baker/render/picture/image.hpp"
#include "samples/demo/simulate.hpp"

namespace sinew::demo {

// The whole run, with a mark at now_s.
render::Image error_chart(const std::vector<FrameRecord>& frames, double now_s, int width, int height);

}  // namespace sinew::demo

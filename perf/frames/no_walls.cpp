// no_walls.cpp  In a build without Embree.
#include "perf/frames/walls.hpp"

namespace sinew::perf {

std::unique_ptr<OcclusionSource> make_walls(uint32_t) { return nullptr; }

}  // namespace sinew::perf

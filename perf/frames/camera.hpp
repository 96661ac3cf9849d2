// camera.hpp  Where a scene is seen from.
#pragma once
#include "perf/frames/scene.hpp"
#include "sinew/view.hpp"

namespace sinew::perf {

// From beyond a corner of the floor: shows all who stand on it, the nearest about ten times as large as the
// farthest.
View overview(uint32_t instances);
// In this frame: an overview, but for these. Cuts: each second from the place of another one, looking across
// at who stands opposite. Hidden: turned away from the floor. Walls: slowly along them, and back.
View camera_of(const Scene& scene, uint32_t frame);

}  // namespace sinew::perf

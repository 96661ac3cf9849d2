// scene.hpp  What a run of whole frames is up against.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace sinew::perf {

enum class Trouble : uint32_t {
  kNone = 0,
  kCuts,        // the camera is somewhere else every second: those that mattered no longer do, others enter
  kEntrance,    // every two seconds all characters enter at once
  kHitch,       // a frame of 200 ms every second
  kWorkerLost,  // of two workers, one is away for a second in every two
  kNeighbour,   // another process takes half of the core
  kWalls,       // the camera goes along walls that hide some of them (sinew::embree)
  kHidden,      // no view shows them, and poses are set all the same
  kAsleep,      // they stand still, and the same pose is set; there is time for all, so that they fall asleep
  kYardstick,   // no characters, but work that is always the same (perf/frames/yardstick.hpp)
};

inline constexpr uint32_t kFrames_a_second = 60;

struct Scene {
  Trouble trouble = Trouble::kNone;
  uint32_t instances = 1;
  float budget_us = 1000;
};

const char* name_of(Trouble trouble);
// Every trouble, crowds of 1 to 500, budgets of 0.1 to 8 ms.
std::span<const Scene> all_scenes();

}  // namespace sinew::perf

// scene.cpp  see scene.hpp.
#include "perf/frames/scene.hpp"

namespace sinew::perf {
namespace {

constexpr Scene kScenes[] = {
    {Trouble::kNone, 1, 100},          {Trouble::kNone, 16, 100},        {Trouble::kNone, 16, 1000},
    {Trouble::kNone, 100, 500},        {Trouble::kNone, 100, 4000},      {Trouble::kNone, 500, 1000},
    {Trouble::kNone, 500, 8000},       {Trouble::kCuts, 100, 1000},      {Trouble::kCuts, 100, 4000},
    {Trouble::kCuts, 500, 4000},       {Trouble::kEntrance, 16, 500},    {Trouble::kEntrance, 100, 4000},
    {Trouble::kEntrance, 500, 4000},   {Trouble::kHitch, 16, 500},       {Trouble::kHitch, 100, 4000},
    {Trouble::kWorkerLost, 100, 2000}, {Trouble::kNeighbour, 100, 2000}, {Trouble::kWalls, 100, 1000},
    {Trouble::kWalls, 500, 4000},      {Trouble::kHidden, 500, 4000},    {Trouble::kAsleep, 500, 1e6f},
    {Trouble::kYardstick, 0, 100},     {Trouble::kYardstick, 0, 500},    {Trouble::kYardstick, 0, 1000},
    {Trouble::kYardstick, 0, 4000},
};

}  // namespace

const char* name_of(Trouble trouble) {
  constexpr const char* kNames[] = {"steady",    "cuts",  "entrance", "hitch",  "worker lost",
                                    "neighbour", "walls", "hidden",   "asleep", "yardstick"};
  return kNames[static_cast<size_t>(trouble)];
}

std::span<const Scene> all_scenes() { return kScenes; }

}  // namespace sinew::perf

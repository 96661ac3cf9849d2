// event.hpp  What happened to instances, to be asked for after a step.
#pragma once
#include <cstdint>

#include "sinew/id.hpp"

namespace sinew {

enum class EventKind : uint32_t {
  kTeleport = 0,        // the root
  kPartTeleport = 1,    // soft parts or rods by their joints
  kNetworkGivenUp = 2,  // its state was not a number: modes take over for 60 ticks
  kRestart = 3,         // all state was given up: it fades to skinning and restarts
  kRodRecovery = 4,     // rods were put together, or back where they are held
};

// Of instances that are simulated or show some displacement; those that are skinned alone tell none.
struct Event {
  EventKind kind = EventKind::kTeleport;
  InstanceId instance = {};
  uint64_t frame = 0;  // FrameReport::frame of the step
};

}  // namespace sinew

// closed_loop.hpp  A character as the runtime ticks it: poses, modal base, network, guards, its own output
// fed back.
#pragma once
#include <cstddef>
#include <vector>

#include "baker/common/lone_instance.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/measure/true_motion.hpp"

namespace sinew::baker {

// At the motion's start, at rest on the skinning, as the truth starts; by default in the best tier. Regions
// never sleep; there is no budget. The pack and the motion must outlive it.
class ClosedLoop {
 public:
  ClosedLoop(const LoadedPack& character, const TrueMotion& motion);

  void tick();  // to the motion's next tick; as many as it has
  // In this tier, which may change from tick to tick, on a level of control graphs.
  void tick(Tier tier, uint32_t level = 0);
  // Where it stands, to go back to.
  struct Checkpoint {
    size_t tick = 0;
    std::vector<std::byte> state;
  };
  void save(Checkpoint* to) const;
  void restore(const Checkpoint& from);
  const world::Instance& instance() const { return lone_.instance(); }
  uint64_t step_ns() const { return step_ns_; }  // of the last tick, the thread's own time
  // [nodes][3], metres along each node's frame.
  const float* displacement() const { return lone_.instance().tissue.u[0]; }
  const tissue::Network& network() const { return lone_.asset().network; }
  float* network_state() { return lone_.instance().tissue.network_memory; }
  // Nodes held at their limit, and times that the network was given up, so far.
  uint32_t held() const { return lone_.instance().state->tissue.displacement_clamps; }
  uint32_t fallbacks() const {
    return lone_.instance().state->tissue.fallbacks + lone_.instance().state->tissue.restarts;
  }

 private:
  void step(Tier tier, uint32_t level, uint32_t ticks);

  const TrueMotion& motion_;
  LoneInstance lone_;
  size_t tick_ = 0;
  uint64_t step_ns_ = 0;
};

}  // namespace sinew::baker

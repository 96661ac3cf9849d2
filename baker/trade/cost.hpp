// cost.hpp  What a step of an instance takes: world::step_instance, which is all that World::step does for it
// but choosing its tier.
#pragma once
#include <memory>
#include <vector>

#include "baker/measure/closed_loop.hpp"
#include "baker/trade/rows/row.hpp"

namespace sinew::baker {

// One thread, the thread's own time, along the motion. warm: the same instance again; of
// several passes the quickest, for a busy neighbour slows down all that share its core. Extrapolate: between
// ticks of the best tier, which do not count.
Cost warm_cost(const LoadedPack& character, const TrueMotion& motion, Tier tier, uint32_t level);

// Instances enough to fill the last-level cache one and a half times. To make them takes longer than to step
// them: one crowd for all tiers of a character. The character and the motion must outlive it.
class Crowd {
 public:
  Crowd(const LoadedPack& character, const TrueMotion& motion);
  // cold: from the motion's start, each stepped once a round.
  Cost cold_cost(Tier tier, uint32_t level);

 private:
  size_t rounds_;
  std::vector<std::unique_ptr<ClosedLoop>> loops_;
  ClosedLoop::Checkpoint start_;
};

}  // namespace sinew::baker

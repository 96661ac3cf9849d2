// closed_loop.cpp  see closed_loop.hpp.
#include "baker/measure/closed_loop.hpp"

#include <time.h>

#include <algorithm>

namespace sinew::baker {
namespace {

uint64_t thread_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<uint64_t>(now.tv_nsec);
}

}  // namespace

ClosedLoop::ClosedLoop(const LoadedPack& character, const TrueMotion& motion)
    : motion_(motion), lone_(character.bytes()) {
  step(Tier::kSkinning, 0, 0);  // the first pose was held; what the tissue feels begins with the next
}

void ClosedLoop::tick() { tick(lone_.asset().best()); }

void ClosedLoop::tick(Tier tier, uint32_t level) {
  ++tick_;
  step(tier, level, 1);
}

void ClosedLoop::save(Checkpoint* to) const {
  to->tick = tick_;
  to->state = lone_.save();
}

void ClosedLoop::restore(const Checkpoint& from) {
  tick_ = from.tick;
  lone_.restore(from.state);
}

// A step of so many ticks, ending at the pose of tick_; a guard may have ruled the tier out, as in
// world/step/step.cpp.
void ClosedLoop::step(Tier tier, uint32_t level, uint32_t ticks) {
  const world::InstanceState& state = *lone_.instance().state;
  std::ranges::copy(motion_.joints(tick_), lone_.joints().begin());
  lone_.root() = motion_.root(tick_);
  if (tier == Tier::kNetwork && state.fallback_ticks > 0) tier = Tier::kModal;
  if (state.restarting != 0) tier = Tier::kSkinning;
  const uint64_t start_ns = thread_ns();
  lone_.step({.tier = tier, .level = level}, ticks);
  step_ns_ = thread_ns() - start_ns;
}

}  // namespace sinew::baker

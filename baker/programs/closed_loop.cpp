// closed_loop.cpp  see closed_loop.hpp.
#include "baker/programs/closed_loop.hpp"

#include <time.h>

#include <algorithm>

#include "baker/common/bad_input.hpp"
#include "world/snapshot.hpp"
#include "world/tick.hpp"

namespace sinew::baker {
namespace {

uint64_t thread_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<uint64_t>(now.tv_nsec);
}

}  // namespace

ClosedLoop::ClosedLoop(const LoadedPack& character, const TrueMotion& motion) : motion_(motion) {
  Status status = world::open_asset(character.bytes(), &asset_);
  if (status.ok()) status = world::make_instance(asset_, {}, &instance_);
  if (!status.ok()) throw BadInput(status.message);
  step(Tier::kSkinning, 0, 0);  // the first pose was held; what the tissue feels begins with the next
}

void ClosedLoop::tick() { tick(asset_.best()); }

void ClosedLoop::tick(Tier tier, uint32_t level) {
  ++tick_;
  step(tier, level, 1);
}

void ClosedLoop::save(Checkpoint* to) const {
  to->tick = tick_;
  to->state.resize(world::snapshot_bytes(instance_));
  const Status status = world::save(instance_, to->state);
  if (!status.ok()) throw BadInput(status.message);
}

void ClosedLoop::restore(const Checkpoint& from) {
  tick_ = from.tick;
  const Status status = world::restore(instance_, from.state);
  if (!status.ok()) throw BadInput(status.message);
}

// A step of so many ticks, ending at the pose of tick_; a guard may have ruled the tier out, as in
// world/step.cpp.
void ClosedLoop::step(Tier tier, uint32_t level, uint32_t ticks) {
  world::InstanceState& state = *instance_.state;
  std::ranges::copy(motion_.joints(tick_), instance_.next_joints);
  state.next_root = motion_.root(tick_);
  state.has_next = 1;
  if (tier == Tier::kNetwork && state.fallback_ticks > 0) tier = Tier::kModal;
  if (state.restarting != 0) tier = Tier::kSkinning;
  instance_.plan = {.ticks = {.ticks = ticks, .first_tick_s = asset_.tick_s},
                    .dt_s = asset_.tick_s,
                    .tier = tier,
                    .level = level};
  const uint64_t start_ns = thread_ns();
  world::step_instance(instance_, {});
  step_ns_ = thread_ns() - start_ns;
}

}  // namespace sinew::baker

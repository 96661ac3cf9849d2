// closed_loop.cpp  see closed_loop.hpp.
#include "baker/programs/closed_loop.hpp"

#include <algorithm>

#include "baker/common/bad_input.hpp"
#include "world/tick.hpp"

namespace sinew::baker {

ClosedLoop::ClosedLoop(const LoadedPack& character, const TrueMotion& motion) : motion_(motion) {
  Status status = world::open_asset(character.bytes(), &asset_);
  if (status.ok()) status = world::make_instance(asset_, {}, &instance_);
  if (!status.ok()) throw BadInput(status.message);
  step(Tier::kSkinning);  // the first pose was held; what the tissue feels begins with the next
}

void ClosedLoop::tick() {
  ++tick_;
  step(asset_.best());
}

// A step of one tick, ending at the pose of tick_; a guard may have ruled the tier out, as in world/step.cpp.
void ClosedLoop::step(Tier tier) {
  world::InstanceState& state = *instance_.state;
  std::ranges::copy(motion_.joints(tick_), instance_.next_joints);
  state.next_root = motion_.root(tick_);
  state.has_next = 1;
  if (tier == Tier::kNetwork && state.fallback_ticks > 0) tier = Tier::kModal;
  if (state.restarting != 0) tier = Tier::kSkinning;
  instance_.plan = {
      .ticks = {.ticks = 1, .first_tick_s = asset_.tick_s}, .dt_s = asset_.tick_s, .tier = tier};
  world::step_instance(instance_, {});
}

}  // namespace sinew::baker

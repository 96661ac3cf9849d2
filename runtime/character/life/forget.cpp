// forget.cpp  see forget.hpp.
#include "character/life/forget.hpp"

#include <algorithm>
#include <cstring>

#include "character/contacts/push_surface.hpp"
#include "character/motion/teleport.hpp"
#include "character/rest/asleep.hpp"
#include "character/rods/rod_blend.hpp"

namespace sinew::world {

void forget_displacement(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const size_t bytes = sizeof(float) * 3 * instance.level->node_count();
  for (float* shown : instance.shown) std::memset(shown, 0, bytes);
  std::memset(instance.tail, 0, bytes);
  std::memset(instance.tail_velocity, 0, bytes);
  forget_rods(instance);
  forget_carried(instance);
  forget_pushes(instance);
  instance.told = {};
  state.motion_stale = 1;
  state.restarting = 0;
  state.forgotten = 1;
  state.untouched = 1;
  state.tier = Tier::kSkinning;  // so that simulation starts anew, from zero
  state.fallback_ticks = 0;
  state.tail_ticks = kCarryTicks + kFadeTicks;
  state.tail_rides = 0;
  state.fade_ticks = kFadeTicks;
  state.rest_ticks = 0;
  state.seam_ticks = kBlendInTicks;
}

void forget_motion(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  forget_displacement(instance);
  state.at_start = 1;
  instance.displaced = false;
  state.still_ticks = 0;
  state.skips_pose = 0;
  state.without_pose_s = 0;
  wake(instance);
  state.render_fraction = 0;
  forget_teleports(instance);
  state.excitation = 1;
  std::fill_n(state.velocity_m_s, 3, 0.0);
  std::fill_n(state.angular_velocity, 3, 0.0);
}

}  // namespace sinew::world

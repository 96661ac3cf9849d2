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
  for (float* shown : instance.transition.shown) std::memset(shown, 0, bytes);
  std::memset(instance.transition.tail, 0, bytes);
  std::memset(instance.transition.tail_velocity, 0, bytes);
  forget_rods(instance);
  forget_carried(instance);
  forget_pushes(instance);
  instance.told = {};
  state.poses.motion_stale = 1;
  state.restarting = 0;
  state.tissue.forgotten = 1;
  state.tissue.untouched = 1;
  state.tier = Tier::kSkinning;  // so that simulation starts anew, from zero
  state.fallback_ticks = 0;
  state.transition.tail_ticks = kCarryTicks + kFadeTicks;
  state.transition.tail_rides = 0;
  state.transition.fade_ticks = kFadeTicks;
  state.transition.rest_ticks = 0;
  state.transition.seam_ticks = kBlendInTicks;
}

void forget_motion(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  forget_displacement(instance);
  state.poses.at_start = 1;
  instance.marks.displaced = false;
  state.poses.still_ticks = 0;
  state.poses.skips_pose = 0;
  state.poses.without_pose_s = 0;
  wake(instance);
  state.poses.render_fraction = 0;
  forget_teleports(instance);
  state.excitation = 1;
  std::fill_n(state.motion.velocity_m_s, 3, 0.0);
  std::fill_n(state.motion.angular_velocity, 3, 0.0);
}

}  // namespace sinew::world

// dormant.cpp  see dormant.hpp.
#include "character/rest/dormant.hpp"

#include <algorithm>
#include <cstring>

#include "character/motion/pose.hpp"
#include "character/parameters/tuning.hpp"
#include "character/rest/asleep.hpp"
#include "character/rods/rod_contacts.hpp"

namespace sinew::world {
namespace {

constexpr uint32_t kStillTicks = 8;  // poses of the last three, and the two that led there, are then the same

// What is shown does not depend on how far into a tick it is.
bool is_shown_still(const Instance& instance) noexcept {
  const size_t floats = size_t{3} * instance.level->node_count(),
               turns = size_t{4} * instance.asset->rods.slot_count;
  return std::equal(instance.transition.shown[0], instance.transition.shown[0] + floats,
                    instance.transition.shown[1]) &&
         std::equal(instance.rods.shown[0], instance.rods.shown[0] + turns, instance.rods.shown[1]);
}

bool may_be_dormant(const Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const Asset& asset = *instance.asset;
  return frame::is_simulated(state.tier) && state.poses.still_ticks >= kStillTicks &&
         !state.poses.motion_stale && !state.poses.at_start && !instance.marks.cut &&
         state.blend_ticks == kBlendInTicks && state.transition.seam_ticks == kBlendInTicks &&
         state.fallback_ticks == 0 && !instance.contacts.def.source && !touches_surface(instance) &&
         tuning_stands(instance) &&
         regions_asleep(instance) + instance.level->regions_left_out() == asset.pack.regions.size() &&
         rods_asleep(instance) == asset.rods.rod_count && is_shown_still(instance);
}

}  // namespace

bool has_pose(const Instance& instance, std::span<const Matrix34> joints,
              const RootTransform& root) noexcept {
  return same_root(instance.state->motion.root, root) &&
         std::memcmp(instance.motion.joints, joints.data(), joints.size_bytes()) == 0;
}

void watch_pose(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const size_t joints = instance.level->pack.character->joint_count;
  const bool still = has_pose(instance, {instance.motion.next_joints, joints}, state.motion.next_root);
  constexpr uint32_t kLongest = UINT32_MAX / 2;
  // In the first such step, however long, the pose may still be on its way.
  const uint32_t ticks = state.poses.still_ticks > 0 ? instance.plan.ticks.ticks : 1;
  state.poses.still_ticks = still ? std::min(state.poses.still_ticks + ticks, kLongest) : 0;
}

void fall_dormant(Instance& instance) noexcept {
  if (!may_be_dormant(instance)) return;
  instance.state->dormant = 1;
  instance.told.rod_iterations = 0;
  instance.told.rod_residual = 0;
}

void stay_dormant(Instance& instance, double frame_s) noexcept {
  InstanceState& state = *instance.state;
  const frame::TickPlan& ticks = instance.plan.ticks;
  const auto dt_s = static_cast<float>(frame_s);
  instance.marks.entered = instance.marks.changed_level = instance.marks.refined = false;
  instance.marks.cut = instance.marks.held = instance.marks.restarted = instance.marks.fell_back =
      instance.marks.came_back = false;
  instance.times = {};
  instance.cost_factor = 1;
  instance.plan.decision.cost_us = 0;
  state.remainder_s = ticks.remainder_s;
  state.poses.render_fraction = frame::passed_share(ticks, instance.asset->tick_s);
  state.teleports.teleported = 0;
  state.motion.space_changed = 0;  // it stands there, and its space stands
  std::fill_n(state.motion.ride_velocity_m_s, 3, 0.0);
  state.motion.dt_older_s = state.motion.dt_before_s;
  state.motion.dt_before_s = instance.plan.dt_s;
  state.held_s += dt_s;
  state.turn_left_s = std::max(0.0f, state.turn_left_s - dt_s);
  if (state.tier != Tier::kNetwork) state.tissue.ticks_since_network += ticks.ticks;
  state.poses.has_next = 0;
}

}  // namespace sinew::world

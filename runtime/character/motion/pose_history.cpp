// pose_history.cpp  see pose_history.hpp.
#include "character/motion/pose_history.hpp"

namespace sinew::world {

void lay_out_state(const Asset& asset, core::Arena& arena, PoseHistory& to) noexcept {
  const uint32_t joints = asset.pack.character->joint_count;
  for (Matrix34*& pose : to.pose_joints) pose = arena.take<Matrix34>(joints);
  for (tissue::NodePose*& pose : to.poses) pose = arena.take<tissue::NodePose>(asset.node_count());
  to.joint_teleports = arena.take<uint32_t>(joints);
  to.carried_regions = arena.take<uint32_t>(asset.pack.regions.size());
  to.carried_rods = arena.take<uint32_t>(asset.rods.rod_count);
}

void lay_out_scratch(const Asset& asset, core::Arena& arena, PoseHistory& to) noexcept {
  const uint32_t joints = asset.pack.character->joint_count;
  for (JointParts** parts : {&to.parts_older, &to.parts_before, &to.parts, &to.next_parts})
    *parts = arena.take<JointParts>(joints);
  to.tick_joints = arena.take<Matrix34>(joints);
  to.poses_now = arena.take<tissue::NodePose>(asset.node_count());
  to.skin = arena.take<float>(size_t{12} * joints);
  to.joint_size = arena.take<float>(joints);
  to.node_size = arena.take<float>(asset.node_count());
}

}  // namespace sinew::world

// drive_nodes.cpp  see drive_nodes.hpp.
#include "character/tissue/drive_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "character/parameters/air.hpp"
#include "tissue/frames/node_drive.hpp"

namespace sinew::world {
namespace {

// Of each joint, by its volume; whether one is not as it was bound.
bool size_joints(const Instance& instance) noexcept {
  constexpr float kAsBound = 1e-3f, kLeast = 1e-3f, kMost = 1e3f;
  bool other = false;
  for (uint32_t j = 0; j < instance.level->pack.character->joint_count; ++j) {
    const float* m = instance.motion.skin + size_t{12} * j;
    const float volume = std::abs(m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                                  m[2] * (m[4] * m[9] - m[5] * m[8]));
    const bool as_bound = std::abs(volume - 1) < kAsBound;
    instance.motion.joint_size[j] = as_bound ? 1 : std::clamp(std::cbrt(volume), kLeast, kMost);
    other |= !as_bound;
  }
  return other;
}

}  // namespace

// As skinning blends the joints.
const float* size_nodes(const Instance& instance) noexcept {
  if (!size_joints(instance)) return nullptr;
  for (size_t n = 0; n < instance.level->node_count(); ++n) {
    const pack::SkinRecord& skin = instance.level->pack.nodes[n].skin;
    float size = 0;
    for (uint32_t k = 0; k < pack::kInfluences; ++k)
      size += skin.weight[k] * instance.motion.joint_size[skin.joint[k]];
    instance.motion.node_size[n] = size;
  }
  return instance.motion.node_size;
}

void drive_nodes(Instance& instance) noexcept {
  tissue::NodeMotion motion;
  motion.size = size_nodes(instance);
  instance.motion.scaled_nodes = motion.size != nullptr;
  motion.most_m_s2 = instance.parameters.most_m_s2;
  for (int tick = 0; tick < 3; ++tick) {
    motion.pose[tick] = instance.motion.poses[tick];
    std::copy_n(instance.state->motion.tick_root_m[tick], 3, motion.root_position_m[tick]);
  }
  tissue::compute_node_drive(motion, static_cast<float>(instance.asset->tick_s), instance.level->node_count(),
                             instance.tissue.drive);
  if (tunes_air(instance)) add_air(instance);
}

}  // namespace sinew::world

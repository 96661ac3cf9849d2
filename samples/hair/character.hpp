// character.hpp  The bust and its hair as a character of a world: bones that carry the skin, locks as rods,
// capsules about the bones.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "samples/hair/groom.hpp"
#include "sinew/types.hpp"

namespace sinew::sample {

// Chest, neck and head, then each lock's bones, root to tip.
inline constexpr uint32_t kBustJoints = 3;

using Locks = std::vector<std::vector<rods::SegmentDef>>;

// A .sinew file. A lock's first segment is in the head: its holder.
std::vector<std::byte> pack_haired(const Bust& bust, const Locks& locks);

// Where the locks' bones begin and end in the bind pose, one after the other.
struct LockBone {
  Eigen::Vector3d begin, end;
  float radius_m;
};
std::vector<LockBone> lock_bones(const Locks& locks);

// Of all joints, locks as they are combed.
std::vector<Matrix34> haired_pose(std::span<const LockBone> bones, const Turning& turning);
// Of the skin's vertices, x y z, as linear blending of the chest, the neck and the head has them.
std::vector<float> haired_skin(const Bust& bust, const Turning& turning);

}  // namespace sinew::sample

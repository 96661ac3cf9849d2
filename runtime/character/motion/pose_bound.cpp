// pose_bound.cpp  see pose_bound.hpp.
#include "character/motion/pose_bound.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <new>

#include "character/motion/pose.hpp"
#include "character/output/displacement_bound.hpp"
#include "character/parameters/tuning.hpp"
#include "core/status.hpp"
#include "math/rotation.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kStretch = 1.2f;

Vector3f place_of(const Matrix34& joint) noexcept { return {joint.m[0][3], joint.m[1][3], joint.m[2][3]}; }

float longest_rod_m(const RodRig& rig) noexcept {
  float longest = 0;
  for (const RodSeat& seat : rig.seats()) {
    float length = 0;
    for (const RodSlot& slot : rig.slots().subspan(seat.first_slot, seat.slot_count)) length += slot.length_m;
    longest = std::max(longest, length);
  }
  return longest;
}

// Skin weights descend: the first joint moves a vertex most.
float farthest_vertex_m(const pack::PackView& pack, const Matrix34* bind) noexcept {
  float farthest = 0;
  for (size_t v = 0; v < pack.skin.size(); ++v) {
    const Vector3f place = Eigen::Map<const Vector3f>(&pack.positions[3 * v]);
    farthest = std::max(farthest, (place - place_of(bind[pack.skin[v].joint[0]])).norm());
  }
  return farthest;
}

// A node by its limit, and a vertex that is pushed once more by that; of each region that carries it.
float farthest_displaced_m(const Asset& asset) noexcept {
  float farthest = 0;
  for (size_t r = 0; r < asset.pack.regions.size(); ++r)
    farthest = std::max(farthest, static_cast<float>(asset.soft.most_shared[r]) *
                                      std::min(2 * asset.pack.regions[r].displacement_limit_m,
                                               displacement_bound_m(asset, r)));
  return farthest;
}

}  // namespace

Status measure_reach(const Asset& asset, float* out_m) noexcept {
  const pack::PackView& pack = asset.pack;
  const std::unique_ptr<Matrix34[]> bind(new (std::nothrow) Matrix34[pack.joints.size()]);
  if (!bind) return core::make_status(StatusCode::kOutOfCapacity, "asset: no memory for its bind pose");
  bind_pose(pack.joints, bind.get());
  *out_m = farthest_vertex_m(pack, bind.get()) + farthest_displaced_m(asset) + 2 * longest_rod_m(asset.rods);
  return {};
}

void bound_pose(Instance& instance) noexcept {
  const uint32_t joints = instance.level->pack.character->joint_count;
  Eigen::AlignedBox3f box;
  const Matrix34* pose =
      instance.state->poses.has_next ? instance.motion.next_joints : instance.motion.joints;
  for (uint32_t j = 0; j < joints; ++j) box.extend(place_of(pose[j]));
  const InstanceState& state = *instance.state;
  const RootTransform& root = state.poses.has_next ? state.motion.next_root : state.motion.root;
  Eigen::Map<Vector3d>{instance.bound.middle_m} =
      root.scale * (Eigen::Map<const Vector3d>(root.position_m) +
                    quaternion(root.rotation_xyzw) * Vector3d(box.center().cast<double>()));
  instance.bound.radius_m =
      static_cast<float>(root.scale) *
      (box.diagonal().norm() / 2 + kStretch * (instance.asset->reach_m + tuned_reach_m(instance)));
}

}  // namespace sinew::world

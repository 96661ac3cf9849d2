// rod_publish.cpp  Rods at the render time, as joint matrices.
#include "character/rods/rod_publish.hpp"

#include "character/motion/pose.hpp"
#include "character/transition/shares.hpp"
#include "math/rotation.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using RowMatrix34d = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using MapMatrix = Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>;
using MapConst = Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>;

MapMatrix map(Matrix34& m) noexcept { return MapMatrix(&m.m[0][0]); }
RowMatrix34d matrix(const Matrix34& m) noexcept { return MapConst(&m.m[0][0]).cast<double>(); }

// The motion that takes a bone from where its parent's motion brings it to where its segment is.
void move_bone(Instance& instance, uint32_t s, const float* turns) noexcept {
  const RodSlot& slot = instance.asset->rods.slots()[s];
  const RowMatrix34d above = matrix(instance.rods.motion[slot.parent]);
  const Quaterniond turn = quaternion(turns + size_t{4} * s);
  if (slot.bone == pack::kNoIndex) {  // a link goes with its bone
    map(instance.rods.motion[s]) = above.cast<float>();
    return;
  }
  Quaterniond joint;
  joint_rotation(instance.motion.joints[slot.joint], joint.coeffs().data());
  const Quaterniond rest = joint * Quaterniond(slot.offset_xyzw);
  const Vector3d begin = matrix(instance.motion.joints[slot.bone]).col(3);
  RowMatrix34d motion;
  motion.leftCols<3>() = (rest * turn * rest.conjugate()).normalized().toRotationMatrix();
  motion.col(3) = above.leftCols<3>() * begin + above.col(3) - motion.leftCols<3>() * begin;
  map(instance.rods.motion[s]) = motion.cast<float>();
}

}  // namespace

void publish_rods(Instance& instance, const float* turns) noexcept {
  const RodRig& rig = instance.asset->rods;
  instance.rods.are_shown = rig.rod_count > 0 && shown_share(instance) > 0;
  if (!instance.rods.are_shown) return;
  for (const RodSeat& seat : rig.seats()) {
    map(instance.rods.motion[seat.first_slot]).setIdentity();
    for (uint32_t k = 1; k <= seat.segment_count(); ++k) move_bone(instance, seat.first_slot + k, turns);
  }
  for (uint32_t j = 0; j < instance.level->pack.character->joint_count; ++j) {
    const uint32_t carrier = rig.joint_slots[j];
    instance.rods.joints[j] = instance.motion.joints[j];
    if (carrier == pack::kNoIndex) continue;
    const RowMatrix34d by = matrix(instance.rods.motion[carrier]), pose = matrix(instance.motion.joints[j]);
    auto out = map(instance.rods.joints[j]);
    out.leftCols<3>() = (by.leftCols<3>() * pose.leftCols<3>()).cast<float>();
    out.col(3) = (by.leftCols<3>() * pose.col(3) + by.col(3)).cast<float>();
  }
}

}  // namespace sinew::world

// root_motion.cpp  see root_motion.hpp.
#include "character/motion/root_motion.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "character/motion/pose.hpp"
#include "character/rods/rod_motion.hpp"
#include "math/rotation.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using RowMatrix3f = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

Vector3d place_of(const RootTransform& root) noexcept { return Eigen::Map<const Vector3d>(root.position_m); }
Quaterniond rotation_of(const RootTransform& root) noexcept { return quaternion(root.rotation_xyzw); }

RootTransform root_of(const Vector3d& place_m, const Quaterniond& rotation, double scale) noexcept {
  RootTransform root;
  root.scale = scale;
  Eigen::Map<Vector3d>(root.position_m) = place_m;
  Eigen::Map<Eigen::Vector4f>(root.rotation_xyzw) = rotation.normalized().coeffs().cast<float>();
  return root;
}

void turn_poses(const RowMatrix3f& turn, uint32_t count, tissue::NodePose* poses) noexcept {
  for (uint32_t i = 0; i < count; ++i) {
    Eigen::Map<Eigen::Vector3f> place(poses[i].place_m);
    Eigen::Map<RowMatrix3f> rotation(poses[i].rotation);
    place = (turn * place).eval();
    rotation = (turn * rotation).eval();
  }
}

// As a passenger that stood still.
RootTransform carried_by(const RootTransform& from, const RootTransform& to,
                         const RootTransform& root) noexcept {
  const Quaterniond turn = rotation_of(to) * rotation_of(from).conjugate();
  return root_of(place_of(to) + turn * (place_of(root) - place_of(from)), turn * rotation_of(root),
                 root.scale);
}

// So much of the way to the next root.
RootTransform on_the_way(const RootTransform& from, const RootTransform& to, double share) noexcept {
  const Quaterniond was = rotation_of(from);
  return root_of(place_of(from) + share * (place_of(to) - place_of(from)),
                 was * exponential(share * logarithm(was.conjugate() * rotation_of(to))), from.scale);
}

}  // namespace

void move_past(Instance& instance, const RootTransform& root) noexcept {
  InstanceState& state = *instance.state;
  const Vector3d from = place_of(state.motion.root), to = place_of(root);
  const Quaterniond turn = rotation_of(root) * rotation_of(state.motion.root).conjugate();
  for (double* of_step : {state.motion.velocity_m_s, state.motion.velocity_before_m_s}) {
    Eigen::Map<Vector3d> velocity(of_step);
    velocity = (turn * velocity).eval();
  }
  for (double* tick_root : state.motion.tick_root_m) {
    Eigen::Map<Vector3d> place(tick_root);
    place = (turn * (place - from) + to).eval();
  }
  state.motion.root = root;
  if (state.poses.motion_stale) return;  // there is no history
  for (tissue::NodePose* poses : instance.motion.poses)
    turn_poses(turn.toRotationMatrix().cast<float>(), instance.level->node_count(), poses);
  for (float* tick_turn : instance.contacts.tick_turn)
    if (tick_turn)
      Eigen::Map<Eigen::Vector4f>{tick_turn} = (turn * quaternion(tick_turn)).coeffs().cast<float>();
  move_rods(instance, turn, from, to);
}

namespace {

// As if the root had come here so much faster, all the while: counted from something that moves evenly
// nothing else is felt.
void add_velocity(Instance& instance, const Vector3d& added_m_s) noexcept {
  InstanceState& state = *instance.state;
  for (double* of_step : {state.motion.velocity_m_s, state.motion.velocity_before_m_s})
    Eigen::Map<Vector3d>(of_step) += added_m_s;
  if (state.poses.motion_stale) return;  // there is no history
  for (int tick = 0; tick < 3; ++tick)
    Eigen::Map<Vector3d>(state.motion.tick_root_m[tick]) -=
        (state.remainder_s + tick * instance.asset->tick_s) * added_m_s;
  speed_rods(instance, added_m_s);
}

// To where it is in metres of another size.
void resize(Instance& instance, double scale) noexcept {
  InstanceState& state = *instance.state;
  const double share = state.motion.root.scale / scale;
  RootTransform root = state.motion.root;
  for (double& place : root.position_m) place *= share;
  for (double* own : {state.motion.space.position_m, state.motion.ride_velocity_m_s})
    for (int k = 0; k < 3; ++k) own[k] *= share;
  root.scale = scale;
  move_past(instance, root);
  add_velocity(instance, (share - 1) * Eigen::Map<const Vector3d>(state.motion.velocity_m_s));
}

// Its velocity counts from something else: plus or less that of what it rode on, as far as it is felt.
void add_ride(Instance& instance, double sign) noexcept {
  const InstanceState& state = *instance.state;
  add_velocity(instance, sign * static_cast<double>(state.motion.felt_root) *
                             Eigen::Map<const Vector3d>(state.motion.ride_velocity_m_s));
}

// Goes along with its space.
void ride(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const double dt_s = instance.plan.dt_s;
  if (state.motion.space_id != 0 && state.motion.space_id != state.motion.next_space_id)
    add_ride(instance, 1);
  if (state.motion.next_space_id == 0 || state.motion.space_id != state.motion.next_space_id) return;
  const bool moves = !same_root(state.motion.space, state.motion.next_space);
  const RootTransform carried =
      moves ? carried_by(state.motion.space, state.motion.next_space, state.motion.root) : state.motion.root;
  if (dt_s > 0)
    Eigen::Map<Vector3d>(state.motion.ride_velocity_m_s) =
        (place_of(carried) - place_of(state.motion.root)) / dt_s;
  if (moves) move_past(instance, carried);
  if (state.motion.space_changed != 0 && dt_s > 0) add_ride(instance, -1);
}

}  // namespace

void leave_out_unfelt(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  if (state.motion.next_root.scale != state.motion.root.scale) resize(instance, state.motion.next_root.scale);
  ride(instance);
  if (state.motion.felt_root < 1 && !same_root(state.motion.root, state.motion.next_root))
    move_past(instance, on_the_way(state.motion.root, state.motion.next_root,
                                   1 - static_cast<double>(state.motion.felt_root)));
}

void keep_space(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const bool waits =
      state.motion.space_changed != 0 && !(instance.plan.dt_s > 0);  // for a step that tells how it moves
  state.motion.space_changed = waits || state.motion.next_space_id != state.motion.space_id;
  state.motion.space = state.motion.next_space;
  state.motion.space_id = state.motion.next_space_id;
}

}  // namespace sinew::world

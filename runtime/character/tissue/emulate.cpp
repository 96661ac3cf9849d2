// emulate.cpp  see emulate.hpp.
#include "character/tissue/emulate.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "kernels/kernels.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"
#include "tissue/network/deep_emulator.hpp"

namespace sinew::world {
namespace {

using Vector = Eigen::Vector3f;
using Rotation = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

Eigen::Map<const Vector> vector_at(const float* at) noexcept { return Eigen::Map<const Vector>(at); }
Eigen::Map<Vector> vector_at(float* at) noexcept { return Eigen::Map<Vector>(at); }
Eigen::Map<const Rotation> frame_of(const tissue::NodePose& pose) noexcept {
  return Eigen::Map<const Rotation>(pose.rotation);
}

// Where the root was, or will be, against where it was in the last tick.
Vector root_step(const RootMotion& motion, int back) noexcept {
  const auto& roots = motion.tick_root_m;
  Vector step;
  for (int axis = 0; axis < 3; ++axis) step[axis] = static_cast<float>(roots[back][axis] - roots[1][axis]);
  return step;
}

Rotation turned_by(const Vector& bend) noexcept {
  const float angle = bend.norm();
  if (!(angle > 0)) return Rotation::Identity();
  return Eigen::AngleAxisf(angle, bend / angle).toRotationMatrix();
}

// Of nodes [first, last): everything in metres from the root's last tick.
void gather(Instance& instance, size_t first, size_t last, float cell_m) noexcept {
  const Vector ahead = root_step(instance.state->motion, 0), behind = root_step(instance.state->motion, 2);
  const EmulatorScratch& to = instance.tissue.emulator;
  const uint8_t* held = instance.asset->pack.patch_held.data();
  const auto tick_s = static_cast<float>(instance.asset->tick_s);
  for (size_t n = first; n < last; ++n) {
    const tissue::NodePose &next = instance.motion.poses[0][n], &now = instance.motion.poses[1][n],
                           &before = instance.motion.poses[2][n];
    const float size = instance.motion.scaled_nodes ? instance.motion.node_size[n] : 1;
    const size_t at = 3 * n;
    vector_at(to.x_next + at) = vector_at(next.place_m) + ahead;
    vector_at(to.x_now + at) = vector_at(now.place_m);
    vector_at(to.x_before + at) = vector_at(before.place_m) + behind;
    const float moves = held[n] ? 0 : size;  // what is held is where its pose has it
    vector_at(to.u_now + at) =
        vector_at(to.x_now + at) + moves * (frame_of(now) * vector_at(instance.tissue.u[0] + at));
    vector_at(to.u_before + at) =
        vector_at(to.x_before + at) + moves * (frame_of(before) * vector_at(instance.tissue.u[1] + at));
    tissue::PatchView& view = to.views[n];
    Eigen::Map<Rotation>(view.axes) = (frame_of(next) * turned_by(vector_at(next.bend))).transpose();
    view.length_m = size * cell_m;
    const float* gravity_change = instance.tissue.drive + tissue::kNodeDriveWidth * n + 3;
    vector_at(view.fall_m) = size * tick_s * tick_s * (frame_of(next) * vector_at(gravity_change));
  }
}

// l that the network's places stand for; of what is held, the base's, whose modes go on beyond the part.
void take_answer(Instance& instance, const Part& part) noexcept {
  const uint8_t* held = instance.asset->pack.patch_held.data();
  const EmulatorScratch& from = instance.tissue.emulator;
  float *theta = instance.tissue.carry + part.vector, *l = from.l + part.vector;
  tissue::modal_turn(part.base, instance.tissue.q_hat + part.mode, instance.tissue.region[0], theta);
  tissue::warp(theta, instance.tissue.l_hat + part.vector, part.record.node_count, l);
  for (size_t n = part.node; n < part.node + part.record.node_count; ++n) {
    const size_t at = 3 * n;
    if (held[n]) {
      vector_at(from.l + at).setZero();
      continue;
    }
    const float size = instance.motion.scaled_nodes ? instance.motion.node_size[n] : 1;
    const Vector moved = vector_at(from.u_next + at) - vector_at(from.x_next + at);
    vector_at(from.l + at) =
        frame_of(instance.motion.poses[0][n]).transpose() * moved / size - vector_at(from.l + at);
  }
  tissue::turn_back(theta, l, part.record.node_count, l);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    l[i] += instance.tissue.l_hat[part.vector + i];
}

}  // namespace

bool emulate(Instance& instance) noexcept {
  const Asset& asset = *instance.asset;
  const EmulatorScratch& at = instance.tissue.emulator;
  const tissue::Graph& graph = instance.level->graph;
  bool good = true;
  for_each_awake_part(instance, [&](const Part& part) {
    if (!is_emulated(part)) return;
    const auto first = static_cast<uint32_t>(part.node), last = first + part.record.node_count;
    gather(instance, first, last, part.record.cell_m);
    tissue::deep_emulator_step(asset.emulator, {graph.rows, graph.columns},
                               {at.u_now, at.u_before, nullptr, at.x_next, at.x_now, at.x_before,
                                asset.pack.patch_material.data(), asset.pack.patch_held.data(), at.views},
                               first, last, at.u_next, at.step);
    take_answer(instance, part);
    good = good && tissue::all_finite(at.l + part.vector, size_t{3} * part.record.node_count);
  });
  return good;
}

}  // namespace sinew::world

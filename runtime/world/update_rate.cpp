// update_rate.cpp  see update_rate.hpp.
#include "world/update_rate.hpp"

#include <Eigen/Geometry>

#include "world/rotation.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using RowMatrix3f = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

// The step before, as long as the last: the same acceleration, (v - v_before) over half the sum of both
// times.
struct Respacing {
  double of_last, of_before;
  template <class Vector>
  Vector step(const Vector& last, const Vector& before) const {
    return of_last * last + of_before * before;
  }
};

Respacing respacing(uint32_t before_ticks, uint32_t last_ticks) noexcept {
  const double before = before_ticks, last = last_ticks, share = 2 * last / (before + last);
  return {1 - share, share * last / before};
}

Quaterniond rotation_of(const tissue::NodePose& pose) noexcept {
  return Quaterniond(Eigen::Map<const RowMatrix3f>(pose.rotation).cast<double>());
}

void respace_node(const Respacing& as, const tissue::NodePose& now, const tissue::NodePose& before,
                  tissue::NodePose& before2) noexcept {
  const auto place = [](const tissue::NodePose& pose) {
    return Eigen::Map<const Eigen::Vector3f>(pose.place_m);
  };
  const Vector3d last = (place(now) - place(before)).cast<double>(),
                 earlier = (place(before) - place(before2)).cast<double>();
  Eigen::Map<Eigen::Vector3f>(before2.place_m) = place(before) - as.step(last, earlier).cast<float>();
  const Quaterniond middle = rotation_of(before);
  const Vector3d turn = as.step(logarithm(middle.conjugate() * rotation_of(now)),
                                logarithm(rotation_of(before2).conjugate() * middle));
  Eigen::Map<RowMatrix3f>(before2.rotation) = (middle * exponential(-turn)).toRotationMatrix().cast<float>();
}

void respace_root(const Respacing& as, double (&roots)[3][3]) noexcept {
  const Eigen::Map<const Vector3d> now(roots[0]), before(roots[1]);
  Eigen::Map<Vector3d> before2(roots[2]);
  before2 = (before - as.step<Vector3d>(now - before, before - before2)).eval();
}

}  // namespace

HeardBy hearer(Tier tier) noexcept { return tier == Tier::kSpring ? HeardBy::kSprings : HeardBy::kModes; }

uint32_t every_of(const Instance& instance) noexcept {
  const bool each = instance.state->tier == Tier::kNetwork || instance.pushes != nullptr ||
                    instance.asset->rods.slot_count > 0;
  return each ? 1 : instance.state->every;
}

bool begin_tick(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  if (state.motion_stale) {
    state.heard_by = static_cast<uint32_t>(HeardBy::kNobody);
    state.since_ticks = state.spacing_ticks = 1;
  }
  const uint32_t every = every_of(instance);
  const bool knows = state.heard_by == static_cast<uint32_t>(hearer(state.tier));
  instance.heard_now = !knows || state.since_ticks >= every || state.ticks % every == 0;
  return instance.heard_now;
}

void respace_past(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  state.heard_stretch = static_cast<float>(state.since_ticks) / static_cast<float>(state.spacing_ticks);
  if (state.since_ticks == state.spacing_ticks) return;
  const Respacing as = respacing(state.spacing_ticks, state.since_ticks);
  respace_root(as, state.tick_root_m);
  for (uint32_t n = 0; n < instance.level->node_count(); ++n)
    respace_node(as, instance.poses[0][n], instance.poses[1][n], instance.poses[2][n]);
  state.spacing_ticks = state.since_ticks;
}

}  // namespace sinew::world

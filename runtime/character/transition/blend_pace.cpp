// blend_pace.cpp  see blend_pace.hpp.
#include "character/transition/blend_pace.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "character/transition/shares.hpp"
#include "character/transition/simulated_shown.hpp"

namespace sinew::world {
namespace {

// Of the height, a tick. What rides is true beneath: it has all of simulation's own steps in it already.
constexpr float kBlendStep = 0.002f, kRideStep = 0.0014f;
// Of the blend, and of its pace: as perf/jumps.sh wants.
constexpr float kLate = 0.6f * kBlendInTicks, kLatePace = 0.5f;
constexpr float kLeastPace = static_cast<float>(kBlendInTicks) / kLongestBlendTicks;

using MapConst = Eigen::Map<const Eigen::Vector3f>;

// shown = stays + share moves.
struct Way {
  Eigen::Vector3f stays, moves;
};

Way way_of(const Instance& instance, uint32_t node, float tail_share) noexcept {
  const MapConst u(instance.transition.shown[0] + size_t{3} * node),
      tail(instance.transition.tail + size_t{3} * node);
  if (instance.state->transition.tail_rides) return {u + tail, -tail};
  return {tail_share * tail, u - tail_share * tail};
}

// Largest x with |stays + x moves| <= reach; where none has, the x that comes nearest, 0 at least.
float most_of(const Eigen::Vector3f& stays, const Eigen::Vector3f& moves, float reach) noexcept {
  const float along = stays.dot(moves), length2 = moves.squaredNorm();
  if (length2 <= 0) return 1;
  const float room = reach * reach - stays.squaredNorm();
  const float under_root = std::max(along * along + length2 * room, 0.0f);
  return std::max((std::sqrt(under_root) - along) / length2, 0.0f);
}

// Of a tick.
struct Limits {
  float rise = 1;       // the most that the share may rise by
  float own_m = 1e-9f;  // the farthest that simulation itself moves a node
};

Limits limits_of(Instance& instance, float share, float step_m) noexcept {
  take_simulated(instance, 1, instance.tissue.carry);
  const float tail = tail_share(instance);
  Limits limits;
  for (uint32_t n = 0; n < instance.level->node_count(); ++n) {
    const Way way = way_of(instance, n, tail);
    const size_t at = size_t{3} * n;
    const float own_m =
        (MapConst(instance.transition.shown[0] + at) - MapConst(instance.tissue.carry + at)).norm();
    const Eigen::Vector3f stays = way.stays + share * way.moves - MapConst(instance.transition.shown[1] + at);
    limits.rise = std::min(limits.rise, most_of(stays, way.moves, step_m + own_m));
    limits.own_m = std::max(limits.own_m, own_m);
  }
  return limits;
}

float share_of(const Instance& instance) noexcept {
  return instance.state->transition.tail_rides ? 1 - shown_shares(instance).tail : simulated_share(instance);
}

// What began elsewhere than it would have been swings on, and a landing swings it further: what began at
// rest, for longer. How much of that is seen grows with the share.
float usual_pace(const InstanceState& state, float own_m, float slow_m) noexcept {
  if (state.transition.tail_rides) return 1;
  if (!state.transition.from_shown) return std::clamp(slow_m / own_m, kLeastPace, 1.0f);
  return state.blend_ticks >= kLate ? std::clamp(slow_m / own_m, kLatePace, 1.0f) : 1;
}

}  // namespace

void advance_blend(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const float began = state.blend_ticks, share = share_of(instance);
  const float height_m = instance.level->pack.character->height_m;
  const Limits most =
      limits_of(instance, share, height_m * (state.transition.tail_rides ? kRideStep : kBlendStep));
  state.transition.blend_pace = usual_pace(state, most.own_m, height_m * kBlendStep);
  state.blend_ticks = std::min(began + state.transition.blend_pace, float{kBlendInTicks});
  const float rise = share_of(instance) - share;
  if (rise <= most.rise) return;
  state.transition.blend_pace = std::max(state.transition.blend_pace * most.rise / rise, kLeastPace);
  state.blend_ticks = std::min(began + state.transition.blend_pace, float{kBlendInTicks});
}

}  // namespace sinew::world

// rod_blend.cpp  What rods show: simulated, carried on without simulation, and the way between.
#include "character/rods/rod_blend.hpp"

#include <algorithm>

#include "character/rods/rod_motion.hpp"
#include "character/transition/shares.hpp"
#include "math/rotation.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond turn_at(const float* turns, size_t slot) noexcept { return quaternion(turns + 4 * slot); }

void put_turn(float* turns, size_t slot, const Quaterniond& turn) noexcept {
  Eigen::Map<Eigen::Vector4f>(turns + 4 * slot) = turn.normalized().coeffs().cast<float>();
}

Quaterniond share_of(double share, const Quaterniond& turn) noexcept {
  return share == 1 ? turn : exponential(share * logarithm(turn));
}

Quaterniond between(const Quaterniond& from, const Quaterniond& to, double share) noexcept {
  return from * share_of(share, from.conjugate() * to);
}

void advance_tail(RodState& rods, size_t slot) noexcept {
  Eigen::Map<Eigen::Vector3f> velocity(rods.tail_velocity + 3 * slot);
  if (velocity.isZero(0)) return;
  put_turn(rods.tail, slot, turn_at(rods.tail, slot) * exponential(velocity.cast<double>()));
  velocity *= kCarryDamping;
}

// What is shown of what is simulated, so that `turns` holds it, and of a tail.
void blend_rods(const Instance& instance, float simulated, float tail, const float* tails,
                float* turns) noexcept {
  const auto tail_share = static_cast<double>(tail);
  for (size_t s = 0; s < instance.asset->rods.slot_count; ++s) {
    const Quaterniond turn = turn_at(turns, s);
    if (instance.state->transition.tail_rides) {
      put_turn(turns, s, turn * share_of(1 - static_cast<double>(simulated), turn_at(tails, s)));
      continue;
    }
    const Quaterniond fades = share_of(tail_share, turn_at(tails, s));
    put_turn(turns, s, simulated > 0 ? between(fades, turn, static_cast<double>(simulated)) : fades);
  }
}

// Of a tail, as character/transition/blend.cpp has it for tissue: its steps are its velocity, damped from one
// to the next.
void rod_tails_between(const Instance& instance, float x, float* tails) noexcept {
  const InstanceState& state = *instance.state;
  const float before = state.transition.tail_ticks == 0 ? 1 : 1 / kCarryDamping, y = 1 - x;
  const float share = x * (x * (3 - 2 * x) + y * (y * (before + 1) / 2 - x * (1 + kCarryDamping) / 2));
  for (size_t s = 0; s < instance.asset->rods.slot_count; ++s) {
    const Eigen::Map<const Eigen::Vector3f> velocity(instance.rods.tail_velocity + 3 * s);
    put_turn(tails, s, turn_at(instance.rods.tail, s) * exponential((share * velocity).cast<double>()));
  }
}

// Where no tick has followed the motion yet.
const float* go_on_as_shown(const Instance& instance, float x, float* turns) noexcept {
  for (size_t s = 0; s < instance.asset->rods.slot_count; ++s) {
    const Quaterniond now = turn_at(instance.rods.shown[0], s), before = turn_at(instance.rods.shown[1], s);
    put_turn(turns, s, now * share_of(static_cast<double>(x), before.conjugate() * now));
  }
  return turns;
}

}  // namespace

void forget_rods(Instance& instance) noexcept {
  const size_t slots = instance.asset->rods.slot_count;
  for (float* turns :
       {instance.rods.turn, instance.rods.shown[0], instance.rods.shown[1], instance.rods.tail})
    for (size_t s = 0; s < slots; ++s) put_turn(turns, s, Quaterniond::Identity());
  std::fill_n(instance.rods.tail_velocity, 3 * slots, 0.0f);
}

void begin_rod_tails(Instance& instance, float velocity_kept) noexcept {
  for (size_t s = 0; s < instance.asset->rods.slot_count; ++s) {
    std::copy_n(instance.rods.shown[0] + 4 * s, 4, instance.rods.tail + 4 * s);
    Eigen::Map<Eigen::Vector3f>(instance.rods.tail_velocity + 3 * s) =
        velocity_kept *
        logarithm(turn_at(instance.rods.shown[1], s).conjugate() * turn_at(instance.rods.shown[0], s))
            .cast<float>();
  }
}

void ride_rods(Instance& instance) noexcept {
  for (size_t s = 0; s < instance.asset->rods.slot_count; ++s)
    put_turn(instance.rods.tail, s,
             turn_at(instance.rods.turn, s).conjugate() * turn_at(instance.rods.shown[0], s));
}

void take_rods_as_shown(Instance& instance) noexcept {
  std::copy_n(instance.rods.shown[0], size_t{4} * instance.asset->rods.slot_count, instance.rods.turn);
}

void show_rods(Instance& instance, float simulated) noexcept {
  const size_t slots = instance.asset->rods.slot_count;
  std::copy_n(instance.rods.shown[0], 4 * slots, instance.rods.shown[1]);
  std::copy_n(instance.rods.turn, 4 * slots, instance.rods.shown[0]);
  if (simulated == 1) return;
  if (!instance.state->transition.tail_rides)
    for (size_t s = 0; s < slots; ++s) advance_tail(instance.rods, s);
  blend_rods(instance, simulated, tail_share(instance), instance.rods.tail, instance.rods.shown[0]);
}

const float* rods_shown_now(Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const float x = state.poses.render_fraction, share = simulated_share(instance, x);
  const bool simulated = frame::is_simulated(state.tier);
  const bool shows = instance.asset->rods.rod_count > 0 && shown_share(instance) > 0;
  if (!shows || x == 0) return instance.rods.shown[0];
  float *turns = instance.rods.between, *tails = instance.rods.orientations;
  if (simulated && state.poses.motion_stale) return go_on_as_shown(instance, x, turns);
  if (simulated) turn_rods_between(instance, x, turns);
  if (share == 1) return turns;
  if (state.transition.tail_rides)
    std::copy_n(instance.rods.tail, 4 * instance.asset->rods.slot_count, tails);
  else
    rod_tails_between(instance, x, tails);
  blend_rods(instance, share, tail_share(instance, x), tails, turns);
  return turns;
}

}  // namespace sinew::world

// rod_blend.cpp  What rods show: simulated, carried on without simulation, and the way between.
#include "world/rod_blend.hpp"

#include <algorithm>

#include "world/rotation.hpp"

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

void advance_tail(Instance& instance, size_t slot) noexcept {
  Eigen::Map<Eigen::Vector3f> velocity(instance.rod_tail_velocity + 3 * slot);
  if (velocity.isZero(0)) return;
  put_turn(instance.rod_tail, slot, turn_at(instance.rod_tail, slot) * exponential(velocity.cast<double>()));
  velocity *= kCarryDamping;
}

}  // namespace

void forget_rods(Instance& instance) noexcept {
  const size_t slots = instance.asset->rods.slot_count;
  for (float* turns : {instance.rod_turn, instance.rod_shown[0], instance.rod_shown[1], instance.rod_tail})
    for (size_t s = 0; s < slots; ++s) put_turn(turns, s, Quaterniond::Identity());
  std::fill_n(instance.rod_tail_velocity, 3 * slots, 0.0f);
}

void begin_rod_tails(Instance& instance, float velocity_kept) noexcept {
  for (size_t s = 0; s < instance.asset->rods.slot_count; ++s) {
    std::copy_n(instance.rod_shown[0] + 4 * s, 4, instance.rod_tail + 4 * s);
    Eigen::Map<Eigen::Vector3f>(instance.rod_tail_velocity + 3 * s) =
        velocity_kept *
        logarithm(turn_at(instance.rod_shown[1], s).conjugate() * turn_at(instance.rod_shown[0], s))
            .cast<float>();
  }
}

void ride_rods(Instance& instance) noexcept {
  for (size_t s = 0; s < instance.asset->rods.slot_count; ++s)
    put_turn(instance.rod_tail, s,
             turn_at(instance.rod_turn, s).conjugate() * turn_at(instance.rod_shown[0], s));
}

void take_rods_as_shown(Instance& instance) noexcept {
  std::copy_n(instance.rod_shown[0], size_t{4} * instance.asset->rods.slot_count, instance.rod_turn);
}

void show_rods(Instance& instance, float simulated) noexcept {
  const size_t slots = instance.asset->rods.slot_count;
  const double tail_share = static_cast<double>(instance.tail_share());
  std::copy_n(instance.rod_shown[0], 4 * slots, instance.rod_shown[1]);
  if (simulated == 1) return void(std::copy_n(instance.rod_turn, 4 * slots, instance.rod_shown[0]));
  for (size_t s = 0; s < slots; ++s) {
    if (instance.state->tail_rides) {
      const Quaterniond off = share_of(1 - static_cast<double>(simulated), turn_at(instance.rod_tail, s));
      put_turn(instance.rod_shown[0], s, turn_at(instance.rod_turn, s) * off);
      continue;
    }
    advance_tail(instance, s);
    const Quaterniond tail = share_of(tail_share, turn_at(instance.rod_tail, s));
    put_turn(
        instance.rod_shown[0], s,
        simulated > 0 ? between(tail, turn_at(instance.rod_turn, s), static_cast<double>(simulated)) : tail);
  }
}

}  // namespace sinew::world

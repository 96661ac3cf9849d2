// rod_sleep.cpp  Rods at rest are not stepped.
#include "character/rest/rod_sleep.hpp"

#include <algorithm>
#include <cmath>

#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "character/rods/rod_contacts.hpp"

namespace sinew::world {
namespace {

// Sine of half the angle between two unit quaternions, by what lies across.
template <class T>
double half_turn(const T* a, const T* b) noexcept {
  double dot = 0, square = 0;
  for (int k = 0; k < 4; ++k) dot += static_cast<double>(a[k]) * static_cast<double>(b[k]);
  const double sign = dot < 0 ? -1 : 1;
  for (int k = 0; k < 4; ++k) {
    const double difference = static_cast<double>(a[k]) - sign * static_cast<double>(b[k]);
    square += difference * difference;
  }
  return std::sqrt(square) / 2;  // chord over two
}

// Without holders, which the character does not have.
double length_of(const RodRig& rig, const RodSeat& seat) noexcept {
  double length_m = 0;
  for (const RodSlot& slot : rig.slots().subspan(seat.first_slot + 1, seat.segment_count()))
    length_m += static_cast<double>(slot.length_m);
  return length_m;
}

// By compare, so that NaN is never near.
bool is_held_alike(const Instance& instance, double tolerance) noexcept {
  const RodRig& rig = instance.asset->rods;
  for (uint32_t s = 0; s < rig.slot_count; ++s)
    if (!(2 * half_turn(instance.rods.rest[0] + size_t{4} * s, instance.rods.asleep + size_t{4} * s) <=
          tolerance))
      return false;
  const auto moved_m = [&](size_t hold) {
    const double *now = instance.rods.hold[0] + 3 * hold, *then = instance.rods.hold_asleep + 3 * hold;
    return std::hypot(now[0] - then[0], now[1] - then[1], now[2] - then[2]);
  };
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) {
    const RodSeat& seat = rig.seats()[rod];
    const double near_m = tolerance * length_of(rig, seat);
    if (!(moved_m(rod) <= near_m)) return false;
    if (seat.end_hold != pack::kNoIndex && !(moved_m(size_t{rig.rod_count} + seat.end_hold) <= near_m))
      return false;
  }
  return true;
}

bool stays(const Instance& instance, double tolerance) noexcept {
  constexpr double kATick = 0.1;
  for (uint32_t s = 0; s < instance.asset->rods.slot_count; ++s)
    if (!(2 * half_turn(instance.rods.turn + size_t{4} * s, instance.rods.shown[0] + size_t{4} * s) <=
          kATick * tolerance))
      return false;
  return true;
}

}  // namespace

bool rods_are_held_as_asleep(const Instance& instance) noexcept {
  const float tolerance = instance.parameters.sleep_tolerance;
  return tolerance > 0 && is_held_alike(instance, static_cast<double>(tolerance));
}

bool rods_sleep_on(Instance& instance) noexcept {
  uint32_t& quiet_ticks = instance.state->rods.quiet_ticks;
  const bool alike = quiet_ticks > 0 && rods_are_held_as_asleep(instance);
  const bool sleeps = alike && quiet_ticks >= kRodsQuietTicks;
  if (alike && !(sleeps && something_is_near_rods(instance))) return sleeps;
  const RodRig& rig = instance.asset->rods;
  quiet_ticks = 0;
  std::copy_n(instance.rods.rest[0], size_t{4} * rig.slot_count, instance.rods.asleep);
  std::copy_n(instance.rods.hold[0], size_t{3} * rig.hold_count(), instance.rods.hold_asleep);
  return false;
}

void watch_rods(Instance& instance) noexcept {
  const float tolerance = instance.parameters.sleep_tolerance;
  uint32_t& quiet_ticks = instance.state->rods.quiet_ticks;
  const bool free = instance.told.rod_contacts == 0;
  const bool quiet = tolerance > 0 && free && stays(instance, static_cast<double>(tolerance));
  quiet_ticks = quiet ? quiet_ticks + 1 : 0;
}

}  // namespace sinew::world

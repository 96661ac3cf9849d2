// rod_state.cpp  see rod_state.hpp.
#include "character/rods/rod_state.hpp"

namespace sinew::world {

void lay_out_state(const Asset& asset, core::Arena& arena, RodState& to) noexcept {
  const size_t slots = asset.rods.slot_count, holds = asset.rods.hold_count();
  for (float** turns : {&to.turn, &to.shown[0], &to.shown[1], &to.tail})
    *turns = arena.take<float>(4 * slots);
  to.tail_velocity = arena.take<float>(3 * slots);
  to.asleep = arena.take<double>(4 * slots);
  to.hold_asleep = arena.take<double>(3 * holds);
  for (double*& rest : to.rest) rest = arena.take<double>(4 * slots);
  for (double*& hold : to.hold) hold = arena.take<double>(3 * holds);
}

void lay_out_scratch(const Asset& asset, core::Arena& arena, RodState& to) noexcept {
  const size_t slots = asset.rods.slot_count;
  to.rest_now = arena.take<double>(4 * slots);
  to.hold_now = arena.take<double>(size_t{3} * asset.rods.hold_count());
  for (float** turns : {&to.orientations, &to.between}) *turns = arena.take<float>(4 * slots);
  to.velocity = arena.take<float>(6 * slots);
  for (double*& end : to.end) end = arena.take<double>(3 * slots);
  to.motion = arena.take<Matrix34>(slots);
  to.joints = arena.take<Matrix34>(slots > 0 ? asset.pack.character->joint_count : 0);
}

}  // namespace sinew::world

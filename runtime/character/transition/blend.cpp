// blend.cpp  Simulated displacement, its continuation without simulation, and the way between them.
#include "character/transition/blend.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "character/motion/motion.hpp"
#include "character/motion/teleport.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/parameters/tuning.hpp"
#include "character/rest/asleep.hpp"
#include "character/rods/rod_blend.hpp"
#include "character/tissue/hand_over.hpp"
#include "character/transition/blend_pace.hpp"
#include "character/transition/catch_up.hpp"
#include "character/transition/shares.hpp"
#include "character/transition/simulated_shown.hpp"
#include "tissue/frames/node_bend.hpp"
#include "tissue/modes/guard.hpp"

namespace sinew::world {
namespace {

size_t floats_of(const Instance& instance) noexcept { return size_t{3} * instance.level->node_count(); }

void copy(const Instance& instance, const float* from, float* to) noexcept {
  std::memcpy(to, from, sizeof(float) * floats_of(instance));
}

// So many that no node moves by more than kStep a tick for the fade alone, which is 1.5 times as steep at its
// middle as in the mean.
uint16_t fade_ticks_of(const Instance& instance) noexcept {
  constexpr float kStep = 0.0028f, kSteepest = 1.5f;  // of the height
  float far_m = 0;
  for (const float* u = instance.transition.tail; u != instance.transition.tail + floats_of(instance); u += 3)
    far_m = std::max(far_m, std::hypot(u[0], u[1], u[2]));
  const float ticks = kSteepest * far_m / (kStep * instance.level->pack.character->height_m);
  return static_cast<uint16_t>(
      std::min(std::max(float{kFadeTicks}, std::ceil(ticks)), float{kLongestFadeTicks}));
}

void begin_tail(Instance& instance, float velocity_kept) noexcept {
  copy(instance, instance.transition.shown[0], instance.transition.tail);
  for (size_t i = 0; i < floats_of(instance); ++i) {
    instance.transition.tail_velocity[i] =
        velocity_kept * (instance.transition.shown[0][i] - instance.transition.shown[1][i]);
  }
  begin_rod_tails(instance, velocity_kept);
  instance.state->transition.fade_ticks = fade_ticks_of(instance);
  instance.state->transition.tail_ticks = 0;
  instance.state->transition.tail_rides = 0;
}

// From what is shown. What was not simulated for a while is blended in; from rest there is nothing to blend:
// zero is exact. What was left alone for longer than is caught up with tells nothing of how flesh moves: what
// is blended in begins where the tick would hold it at rest, and swings less than from there
// (character/tissue/simulate.cpp); after a pose that only counts as held in the next tick again, for the
// first knows no acceleration.
void begin_simulation(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  settle_tuning(instance);
  pose_now(instance, instance.motion.poses[0]);
  for (int tick = 0; tick < 2; ++tick) {
    tissue::along_frame(instance.motion.poses[0], instance.transition.shown[tick],
                        instance.level->node_count(), instance.tissue.u[tick]);
    take_out_intensity(instance, instance.tissue.u[tick]);
    copy(instance, instance.tissue.u[tick], instance.tissue.l[tick]);
  }
  take_rods_as_shown(instance);
  forget_carried(instance);
  state.poses.motion_stale = 1;
  state.blend_ticks = state.tissue.untouched ? kBlendInTicks : 0.0f;
  const bool rests = state.transition.tail_ticks > kCaughtUpTicks && !state.tissue.untouched;
  state.transition.from_shown = !rests && !state.tissue.untouched;
  state.transition.rest_ticks = !rests ? 0 : state.motion.dt_before_s > 0 ? 1 : 2;
  lift_displacement(instance);
}

// A network that missed a moment keeps its memory, of everything but where the tissue is. At rest an empty
// one is exact.
void begin_network(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const GraphLevel& level = *instance.level;
  const bool remembered = !state.tissue.forgotten && state.tissue.ticks_since_network <= kRememberedTicks;
  const auto take_place = remembered ? tissue::write_output : tissue::rebase_state;
  take_place(instance.asset->network, level.pack.regions, level.node_count(), instance.tissue.l[0],
             instance.tissue.network_memory);
  if (!remembered) state.tissue.network_begins = state.tissue.untouched ? 0 : kNetworkBeginTicks;
  state.tissue.forgotten = 0;
}

// Where ticks were missed, what is taken back holds them back enough.
void hand_to_modes(Instance& instance) noexcept {
  instance.marks.made_up > 0 ? take_back_corrections(instance) : slow_modes(instance);
}

// Of nodes, and how many ticks after it began it is to be brought to.
struct Tail {
  float *u, *velocity;
  uint32_t ticks;
};

// A tail may not run where the network may not go.
void hold_at_limit(float* u, float* velocity, float limit_m) noexcept {
  const float length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  if (!(length > limit_m)) return;
  for (int k = 0; k < 3; ++k) {
    u[k] *= limit_m / length;
    velocity[k] = 0;
  }
}

// So that a tail that has run out costs nothing to publish.
void stop_what_creeps(const Instance& instance, const Tail& tail) noexcept {
  constexpr float kCreep = 1e-4f;  // of the region's radius, a tick
  for (const pack::RegionRecord& region : instance.level->pack.regions) {
    const float slow_m = kCreep * region.radius_m;
    float* velocity = tail.velocity + size_t{3} * region.first_node;
    for (float* end = velocity + size_t{3} * region.node_count; velocity != end; ++velocity)
      if (std::abs(*velocity) < slow_m) *velocity = 0;
  }
}

// What is let go of where it was pressed hardest would fling faster than it ever moved. Before that tick it
// is free, for the nearer it is to where it would have been, the less is seen of its coming back.
void hold_speed(const Instance& instance, const float* before, float* v) noexcept {
  constexpr float kMost = 0.0027f;  // of the height, a tick
  const auto length = [](const float* x) { return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); };
  const float most_m = std::max(kMost * instance.level->pack.character->height_m, length(before));
  const float speed_m = length(v);
  if (!(speed_m > most_m)) return;
  for (int k = 0; k < 3; ++k) v[k] *= most_m / speed_m;
}

// What is not driven swings as its first mode does, u_t = a1 u_{t-1} + a2 u_{t-2}. What it was driven
// by is let go of over the ticks until the fade, and never wholly, for a force that ends at once is seen as a
// jump; and it is damped from the first on.
void swing_tail(const Instance& instance, size_t r, const Tail& tail) noexcept {
  constexpr float kFreest = 0.9f;
  const pack::RegionRecord& region = instance.level->pack.regions[r];
  const tissue::Recurrence first = first_recurrence(instance, r);
  const uint32_t tick = tail.ticks;
  const float free = tick <= kCarryTicks ? std::min(static_cast<float>(tick) / kCarryTicks, kFreest) : 0;
  const float pull = free * (first.a1 + first.a2 - 1), drag = free * (1 + first.a2);
  for (size_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
    float *u = tail.u + 3 * n, *velocity = tail.velocity + 3 * n;
    const float before[3] = {velocity[0], velocity[1], velocity[2]};
    for (int k = 0; k < 3; ++k) velocity[k] += pull * u[k] - drag * velocity[k];
    if (tick > kCaughtUpTicks) hold_speed(instance, before, velocity);
    for (int k = 0; k < 3; ++k) {
      u[k] += velocity[k];
      velocity[k] *= kCarryDamping;
    }
  }
}

uint32_t tail_ticks_after(const InstanceState& state, uint32_t ticks) noexcept {
  return std::min(state.transition.tail_ticks + ticks, kCarryTicks + state.transition.fade_ticks);
}

void count_tail(const Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  state.transition.tail_ticks = tail_ticks_after(state, 1);
  if (state.transition.tail_ticks == kCarryTicks + state.transition.fade_ticks) state.restarting = 0;
}

void advance_tail(const Instance& instance, const Tail& tail) noexcept {
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) swing_tail(instance, r, tail);
  if (tail.ticks > kCarryTicks) stop_what_creeps(instance, tail);
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    const float most_m = shown_limit_m(instance, r);
    for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
      hold_at_limit(tail.u + size_t{3} * n, tail.velocity + size_t{3} * n, most_m);
    }
  }
}

}  // namespace

void enter_tier(Instance& instance, Tier tier) noexcept {
  InstanceState& state = *instance.state;
  const bool simulated = frame::is_simulated(tier), was_simulated = frame::is_simulated(state.tier);
  if (simulated && !was_simulated) begin_simulation(instance);
  if (!simulated && was_simulated) {
    begin_tail(instance, 1);
    begin_gap(instance);
  }
  if (tier == Tier::kModal && state.tier == Tier::kNetwork) hand_to_modes(instance);
  if (tier == Tier::kNetwork && state.tier != Tier::kNetwork) begin_network(instance);
  if (tier != state.tier) wake_regions(instance);
  if (tier == Tier::kSkinning)
    state.transition.tail_ticks = std::max(state.transition.tail_ticks, kCarryTicks);
  state.tier = tier;
}

void restart(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  begin_tail(instance, 0);
  // Before they are used again they are filled anew, but zero times NaN would be shown.
  for (float* u : instance.tissue.u) std::memset(u, 0, sizeof(float) * floats_of(instance));
  state.transition.tail_ticks = kCarryTicks;
  state.tier = Tier::kSkinning;
  state.poses.motion_stale = 1;
  state.restarting = 1;
  state.tissue.forgotten = 1;
  wake_regions(instance);
  ++state.tissue.restarts;
  instance.marks.restarted = true;
}

// A cubic of Hermite; the velocity at a tick is the mean of the steps before and after it.
void tail_between(Instance& instance, float x, float* out) noexcept {
  const InstanceState& state = *instance.state;
  const float undamped = state.transition.tail_ticks == 0 ? 1 : 1 / kCarryDamping, y = 1 - x;
  float *next = instance.tissue.l_hat, *velocity = instance.tissue.carry;
  copy(instance, instance.transition.tail, next);
  copy(instance, instance.transition.tail_velocity, velocity);
  advance_tail(instance, {next, velocity, tail_ticks_after(state, 1)});
  copy(instance, next, out);
  advance_tail(instance, {next, velocity, tail_ticks_after(state, 2)});
  for (size_t i = 0; i < floats_of(instance); ++i) {
    const float step = out[i] - instance.transition.tail[i], step_after = next[i] - out[i];
    const float begins = (undamped * instance.transition.tail_velocity[i] + step) / 2,
                ends = (step + step_after) / 2;
    out[i] = instance.transition.tail[i] + x * (x * (3 - 2 * x) * step + y * (y * begins - x * ends));
  }
}

void show_tick(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  count_tail(instance);
  if (frame::is_simulated(state.tier)) state.transition.rest_ticks -= state.transition.rest_ticks > 0;
  if (state.transition.seam_ticks < kBlendInTicks) ++state.transition.seam_ticks;
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r)
    if (instance.transition.regained[r] == kRegainedNow) instance.transition.regained[r] = kRegained;
  const bool simulates = frame::is_simulated(state.tier);
  const bool blends = simulates && state.blend_ticks < kBlendInTicks;
  if ((blends || !simulates) && !state.transition.tail_rides)
    advance_tail(instance,
                 {instance.transition.tail, instance.transition.tail_velocity, state.transition.tail_ticks});
  copy(instance, instance.transition.shown[0], instance.transition.shown[1]);
  if (simulates) take_simulated(instance, 0, instance.transition.shown[0]);
  if (blends) advance_blend(instance);
  if (state.blend_ticks == kBlendInTicks) state.transition.tail_rides = 0;
  show_rods(instance, simulated_share(instance));
  const auto [simulated, tail] = shown_shares(instance);
  if (simulated == 1 && tail == 0) return;
  for (size_t i = 0; i < floats_of(instance); ++i) {
    instance.transition.shown[0][i] =
        simulated * instance.transition.shown[0][i] + tail * instance.transition.tail[i];
  }
}

void show_nothing(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  state.transition.tail_ticks = kCarryTicks + kFadeTicks;
  state.transition.fade_ticks = kFadeTicks;
  state.transition.seam_ticks = kBlendInTicks;
  state.restarting = 0;
  for (float* none : {instance.transition.shown[0], instance.transition.shown[1], instance.transition.tail,
                      instance.transition.tail_velocity})
    std::memset(none, 0, sizeof(float) * floats_of(instance));
  forget_rods(instance);
}

}  // namespace sinew::world

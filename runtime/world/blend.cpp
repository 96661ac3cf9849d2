// blend.cpp  The network's displacement, its continuation without the network, and the way between them.
#include "world/blend.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tissue/guard.hpp"
#include "tissue/network.hpp"

namespace sinew::world {
namespace {

size_t floats_of(const Instance& instance) noexcept { return size_t{3} * instance.asset->node_count(); }

void copy(const Instance& instance, const float* from, float* to) noexcept {
  std::memcpy(to, from, sizeof(float) * floats_of(instance));
}

void begin_tail(Instance& instance, float velocity_kept) noexcept {
  copy(instance, instance.shown[0], instance.tail);
  for (size_t i = 0; i < floats_of(instance); ++i) {
    instance.tail_velocity[i] = velocity_kept * (instance.shown[0][i] - instance.shown[1][i]);
  }
  instance.state->tail_ticks = 0;
}

// y of the last layer is the displacement; everything else stays.
void move_output(Instance& instance, const float* displacement) noexcept {
  const tissue::Network& network = instance.asset->network;
  const uint32_t nodes = instance.asset->node_count();
  const auto last = static_cast<uint32_t>(network.layers.size() - 1);
  float* y = tissue::layer_state(network, nodes, last, instance.network_state).y;
  for (size_t n = 0; n < nodes; ++n) {
    for (size_t k = 0; k < 3; ++k) {
      y[n * network.layers[last].padded + k] = displacement[3 * n + k] / network.record->length_unit_m;
    }
  }
}

void begin_network(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  const bool remembered = !state.forgotten && state.ticks_since_network <= kRememberedTicks;
  if (remembered)
    move_output(instance, instance.shown[0]);
  else
    tissue::rebase_state(instance.asset->network, instance.asset->node_count(), instance.shown[0],
                         instance.network_state);
  state.forgotten = 0;
  copy(instance, instance.shown[0], instance.simulated[0]);
  copy(instance, instance.shown[1], instance.simulated[1]);
  state.motion_stale = 1;
  state.clamped_ticks = 0;
  // From rest there is nothing to blend: the network's zero is exact.
  state.blend_ticks = state.untouched ? kBlendInTicks : 0;
}

// A tail may not run where the network may not go.
void hold_at_limit(float* u, float* velocity, float limit_m) noexcept {
  const float length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  if (!(length > limit_m)) return;
  for (int k = 0; k < 3; ++k) {
    u[k] *= limit_m / length;
    velocity[k] = 0;
  }
}

void advance_tail(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  constexpr uint32_t kOver = kCarryTicks + kFadeTicks;
  if (state.tail_ticks < kOver) ++state.tail_ticks;
  if (state.tail_ticks == kOver) state.restarting = 0;
  for (size_t i = 0; i < floats_of(instance); ++i) {
    instance.tail[i] += instance.tail_velocity[i];
    instance.tail_velocity[i] *= kCarryDamping;
  }
  for (const pack::RegionRecord& region : instance.asset->pack.regions) {
    for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
      hold_at_limit(instance.tail + size_t{3} * n, instance.tail_velocity + size_t{3} * n,
                    region.displacement_limit_m);
    }
  }
}

}  // namespace

void enter_tier(Instance& instance, Tier tier) noexcept {
  InstanceState& state = *instance.state;
  if (tier == Tier::kNetwork && state.tier != Tier::kNetwork) begin_network(instance);
  if (tier != Tier::kNetwork && state.tier == Tier::kNetwork) begin_tail(instance, 1);
  if (tier == Tier::kSkinning) state.tail_ticks = std::max(state.tail_ticks, kCarryTicks);
  state.tier = tier;
}

void restart(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  begin_tail(instance, 0);
  const size_t state_floats = tissue::state_floats(instance.asset->network, instance.asset->node_count());
  std::memset(instance.network_state, 0, sizeof(float) * state_floats);
  state.tail_ticks = kCarryTicks;
  state.tier = Tier::kSkinning;
  state.restarting = 1;
  state.forgotten = 1;
  ++state.restarts;
  instance.restarted = true;
}

void show_tick(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  advance_tail(instance);
  if (state.tier == Tier::kNetwork && state.blend_ticks < kBlendInTicks) ++state.blend_ticks;
  const float network = instance.network_share();
  const float tail = (1 - network) * instance.tail_share();
  copy(instance, instance.shown[0], instance.shown[1]);
  if (network == 1) return copy(instance, instance.simulated[0], instance.shown[0]);
  for (size_t i = 0; i < floats_of(instance); ++i) {
    instance.shown[0][i] = network * instance.simulated[0][i] + tail * instance.tail[i];
  }
}

}  // namespace sinew::world

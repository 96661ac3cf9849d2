// spend_corrections.cpp  see spend_corrections.hpp.
#include "character/tissue/spend_corrections.hpp"

#include <algorithm>
#include <cmath>

#include "character/parameters/tuned_parts.hpp"
#include "character/tissue/emulate.hpp"
#include "character/tissue/region_part.hpp"
#include "kernels/kernels.hpp"
#include "tissue/modes/correction_budget.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"

namespace sinew::world {
namespace {

// A network that begins knows nothing of the motion yet: its corrections rise.
float begun_share(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  if (state.tissue.network_begins == 0) return 1;
  --state.tissue.network_begins;
  return 1 - static_cast<float>(state.tissue.network_begins) / kNetworkBeginTicks;
}

bool is_near(const float* a, const float* b, size_t count, float distance) noexcept {
  float most = 0;
  for (size_t i = 0; i < count; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most <= distance;
}

// Of the region's nodes, over the last three ticks: none turned or moved against the root, which went on as
// it did, by more than rounding.
bool pose_stays(const Instance& instance, const Part& part) noexcept {
  constexpr float kRounding = 1e-5f;  // radians, and of the radius
  const float least_m = kRounding * part.record.radius_m;
  const double(&root)[3][3] = instance.state->motion.tick_root_m;
  for (size_t axis = 0; axis < 3; ++axis)
    if (std::abs(root[0][axis] - 2 * root[1][axis] + root[2][axis]) > static_cast<double>(least_m))
      return false;
  for (size_t n = part.node; n < part.node + part.record.node_count; ++n)
    for (const int older : {1, 2}) {
      const tissue::NodePose &now = instance.motion.poses[0][n], &then = instance.motion.poses[older][n];
      if (!is_near(now.rotation, then.rotation, 9, kRounding) ||
          !is_near(now.place_m, then.place_m, 3, least_m))
        return false;
    }
  return true;
}

// d of this tick from those of the last two, and what the tick corrects.
void count_corrections(TissueState& tissue, const Part& part, const float* correction) noexcept {
  float *now = tissue.corrected[0] + part.mode, *before = tissue.corrected[1] + part.mode;
  for (size_t m = 0; m < part.base.modes.size(); ++m) {
    const pack::ModeRecord& mode = part.base.modes[m];
    const float goes_on = mode.a1 * now[m] + mode.a2 * before[m];
    before[m] = now[m];
    now[m] = goes_on + correction[m];
  }
}

// The share of a correction that the region's budget allows; the budget becomes this tick's.
float spend_budget(Instance& instance, const Part& part, const float* correction) noexcept {
  float base[pack::kMaxModes];
  const float *d = instance.tissue.corrected[0] + part.mode,
              *d_before = instance.tissue.corrected[1] + part.mode;
  for (size_t m = 0; m < part.base.modes.size(); ++m) {
    const pack::ModeRecord& mode = part.base.modes[m];
    base[m] = instance.tissue.q_hat[part.mode + m] - (mode.a1 * d[m] + mode.a2 * d_before[m]);
  }
  return tissue::bounded_share({.modes = part.base.modes,
                                .base = base,
                                .d = d,
                                .d_before = d_before,
                                .correction = correction,
                                .pose_stays = pose_stays(instance, part)},
                               instance.tissue.swing + part.index);
}

// The network's correction as modes have it, as much of it as its budget allows.
void correct_modes(Instance& instance, const Part& part, float most) noexcept {
  alignas(64) float correction[pack::kMaxModes] = {};
  const size_t modes = part.base.modes.size();
  float* change = instance.tissue.region[0];
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    change[i] = most * (instance.tissue.l[0][part.vector + i] - instance.tissue.l_hat[part.vector + i]);
  tissue::modal_project(part.base, change, correction);
  // The budget's proof wants modes that swing; the baker makes no others.
  for (size_t m = 0; m < modes; ++m) {
    const pack::ModeRecord& mode = part.base.modes[m];
    if (mode.a1 * mode.a1 + 4 * mode.a2 >= 0) correction[m] = 0;
  }
  const float share = spend_budget(instance, part, correction);
  // A correction that is not finite takes no share, and 0 times it is none either.
  for (size_t m = 0; m < modes; ++m) correction[m] = share > 0 ? share * correction[m] : 0;
  simd::kernels().add_rows(part.base.shape, static_cast<uint32_t>(modes), part.base.padded, correction,
                           instance.tissue.region[1]);
  for (size_t i = 0; i < size_t{3} * part.record.node_count; ++i)
    instance.tissue.l[0][part.vector + i] =
        instance.tissue.l_hat[part.vector + i] + instance.tissue.region[1][i];
  for (size_t m = 0; m < modes; ++m) instance.tissue.q[0][part.mode + m] += correction[m];
  count_corrections(instance.tissue, part, correction);
}

// What a network corrected before goes on with the modes; the budget follows.
void settle_part_on_base(Instance& instance, const Part& part) noexcept {
  const float none[pack::kMaxModes] = {};
  std::copy_n(instance.tissue.l_hat + part.vector, size_t{3} * part.record.node_count,
              instance.tissue.l[0] + part.vector);
  spend_budget(instance, part, none);
  count_corrections(instance.tissue, part, none);
}

}  // namespace

void settle_on_network(Instance& instance) noexcept {
  const float all_begun = begun_share(instance);
  // What sleeps keeps its l, of which the network remembers only what is shown.
  for_each_awake_part(instance, [&](const Part& part) {
    const float begun = all_begun * network_share(instance, part.index);
    if (is_emulated(part)) {
      std::copy_n(instance.tissue.emulator.l + part.vector, size_t{3} * part.record.node_count,
                  instance.tissue.l[0] + part.vector);
      return correct_modes(instance, part, begun);
    }
    if (instance.asset->network.layers.empty()) return settle_part_on_base(instance, part);
    tissue::read_output(instance.asset->network, instance.level->pack.regions.subspan(part.index, 1),
                        instance.level->node_count(), instance.tissue.network_memory,
                        instance.tissue.l[0] + part.vector);
    correct_modes(instance, part, begun * instance.tissue.trust[part.index]);
  });
}

void settle_on_base(Instance& instance) noexcept {
  std::copy_n(instance.tissue.l_hat, size_t{3} * instance.level->node_count(), instance.tissue.l[0]);
  if (instance.asset->best() != Tier::kNetwork) return;
  for_each_awake_part(instance, [&](const Part& part) { settle_part_on_base(instance, part); });
}

}  // namespace sinew::world

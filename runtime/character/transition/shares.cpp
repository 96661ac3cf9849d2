// shares.cpp  see shares.hpp.
#include "character/transition/shares.hpp"

#include <algorithm>

namespace sinew::world {
namespace {

float smooth_step(float t) noexcept { return t * t * (3 - 2 * t); }

// Its first three derivatives are zero at both ends.
float gentle_step(float t) noexcept { return t * t * t * t * (35 - t * (84 - t * (70 - 20 * t))); }

// Of the way into a blend.
float blended(const InstanceState& state, float ahead) noexcept {
  return std::min(1.0f, (state.blend_ticks + ahead * state.transition.blend_pace) / kBlendInTicks);
}

}  // namespace

float simulated_share(const Instance& instance, float ahead) noexcept {
  if (!frame::is_simulated(instance.state->tier)) return 0;
  return smooth_step(blended(*instance.state, ahead));
}

float tail_share(const Instance& instance, float ahead) noexcept {
  const float faded =
      static_cast<float>(instance.state->transition.tail_ticks) + ahead - static_cast<float>(kCarryTicks);
  if (faded <= 0) return 1;
  return smooth_step(1 - std::min(faded / static_cast<float>(instance.state->transition.fade_ticks), 1.0f));
}

ShownShares shown_shares(const Instance& instance, float ahead) noexcept {
  if (instance.state->transition.tail_rides) return {1, 1 - gentle_step(blended(*instance.state, ahead))};
  const float b = simulated_share(instance, ahead);
  return {b, (1 - b) * tail_share(instance, ahead)};
}

float shown_share(const Instance& instance) noexcept {
  if (instance.state->transition.tail_rides) return 1;
  const ShownShares shares = shown_shares(instance);
  return shares.simulated + shares.tail;
}

float seam_share(const Instance& instance) noexcept {
  if (!instance.transition.seam || instance.state->transition.seam_ticks >= kBlendInTicks) return 0;
  const float faded =
      (static_cast<float>(instance.state->transition.seam_ticks) + instance.state->poses.render_fraction) /
      kBlendInTicks;
  return smooth_step(1 - std::min(faded, 1.0f));
}

float regained_share(const Instance& instance, size_t region, float ahead) noexcept {
  if (!instance.transition.regained[region] || instance.state->transition.seam_ticks >= kBlendInTicks)
    return 1;
  return smooth_step(
      std::min(1.0f, (static_cast<float>(instance.state->transition.seam_ticks) + ahead) / kBlendInTicks));
}

}  // namespace sinew::world

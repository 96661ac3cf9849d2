// excitation.cpp  see excitation.hpp.
#include "character/motion/excitation.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::world {
namespace {

float root_mean_square_mm(const Instance& instance) noexcept {
  const size_t floats = size_t{3} * instance.level->node_count();
  float squares = 0;
  for (size_t i = 0; i < floats; ++i)
    squares += instance.transition.shown[0][i] * instance.transition.shown[0][i];
  constexpr float kMillimetres = 1e3f;
  return kMillimetres *
         std::sqrt(squares / static_cast<float>(std::max<size_t>(1, instance.level->node_count())));
}

}  // namespace

void follow_excitation(Instance& instance) noexcept {
  constexpr float kSeen_s = 0.33f, kUnknown_s = 3;
  InstanceState& state = *instance.state;
  const bool simulated = frame::is_simulated(state.tier);
  const float now = simulated ? root_mean_square_mm(instance) / instance.asset->skinning_mm : 1;
  const float share =
      std::min(1.0f, static_cast<float>(instance.plan.dt_s) / (simulated ? kSeen_s : kUnknown_s));
  state.excitation += share * (std::clamp(now, kLeastExcitation, kMostExcitation) - state.excitation);
}

}  // namespace sinew::world

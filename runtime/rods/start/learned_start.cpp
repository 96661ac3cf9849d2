// learned_start.cpp  Checks a network and says where its layers lie.
#include "rods/start/learned_start.hpp"

#include <algorithm>
#include <cmath>

#include "core/status.hpp"

namespace sinew::rods {

Status check_learned_start(const CopingNet* network) noexcept {
  if (!network || !network->record || !network->weights) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "RodSettings::network is missing; kLearned needs a coping_net");
  }
  const uint32_t latent = network->record->max_channels;
  if (latent % 8 == 0 && latent <= pack::kPanel) return {};
  return core::make_status(
      StatusCode::kInvalidArgument,
      "RodSettings::network has a latent width of %u; kLearned needs a multiple of 8, at most %u", latent,
      pack::kPanel);
}

simd::RodStartNet start_net(const CopingNet& network) noexcept {
  return {network.layers.data(), network.weights, network.record->max_channels, network.record->blocks,
          network.record->depth};
}

void joint_inputs(const float (&rest)[3], float bend_compliance, float twist_compliance,
                  float (&out)[simd::kRodJointInputs]) noexcept {
  std::copy_n(rest, 3, out);
  out[3] = 0.1f * std::log(bend_compliance);
  out[4] = 0.1f * std::log(twist_compliance);
}

}  // namespace sinew::rods

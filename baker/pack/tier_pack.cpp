// tier_pack.cpp  What a character's tiers cost and how far they are from the truth, as baked.
#include "baker/pack/tier_pack.hpp"

#include <limits>

#include "sinew/types.hpp"

namespace sinew::baker {
namespace {

constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

float cost_us(uint64_t multiply_adds) {
  constexpr double kFlopsEach = 2;
  return static_cast<float>(static_cast<double>(multiply_adds) * kFlopsEach / kBakedCostFlops * 1e6);
}

}  // namespace

uint64_t multiply_adds(std::span<const pack::LayerRecord> layers, size_t nodes, size_t graph_entries) {
  uint64_t total = 0;
  for (const pack::LayerRecord& layer : layers) {
    const uint64_t input_rows = uint64_t{layer.inputs} * (1 + layer.has_self);
    const uint64_t products =
        layer.padded * (4 * input_rows + 4 * uint64_t{layer.channels} + 3 * uint64_t{layer.channels});
    const uint64_t aggregated =
        uint64_t{layer.inputs} + uint64_t{layer.channels};  // x (c of the layer before), h
    total += nodes * products + graph_entries * aggregated;
  }
  const uint64_t outputs = layers.empty() ? 0 : 2 * uint64_t{layers.back().channels};  // y, of then and now
  return total + graph_entries * outputs;
}

std::vector<pack::TierRecord> make_tiers(const TierWork& work, float error_mm, float error_ratio) {
  // A node's share: its damped coordinates; its frame, drive and spring; its terms and warp. The last two are
  // scalar code: so many multiply-adds of the kernels take as long.
  constexpr uint64_t kExtrapolationOps = 3, kSpringOps = 1900, kModalOps = 1100, kRodSegmentOps = 30000;
  const uint64_t spring = work.nodes * kSpringOps + work.rod_segments * kRodSegmentOps;
  const uint64_t modal = spring + work.nodes * kModalOps + work.mode_floats;
  const float skinning_mm = error_ratio > 0 ? error_mm / error_ratio : kNotMeasured;
  const auto record = [](Tier tier, uint64_t ops, float mm = kNotMeasured, float ratio = kNotMeasured) {
    return pack::TierRecord{.tier = static_cast<uint32_t>(tier),
                            .every = 1,
                            .cost_us = cost_us(ops),
                            .cost_p99_us = kNotMeasured,
                            .error_mm = mm,
                            .error_ratio = ratio,
                            .error_p95_mm = kNotMeasured,
                            .reserved = 0};
  };
  std::vector<pack::TierRecord> tiers = {record(Tier::kSkinning, 0, skinning_mm, 1),  // 1 by definition
                                         record(Tier::kExtrapolate, work.nodes * kExtrapolationOps)};
  if (work.network_multiply_adds > 0)
    tiers.push_back(record(Tier::kNetwork, modal + work.network_multiply_adds, error_mm, error_ratio));
  tiers.push_back(record(Tier::kSpring, spring));
  tiers.push_back(record(Tier::kModal, modal));
  return tiers;
}

}  // namespace sinew::baker

// tier_pack.cpp  What a character's tiers cost and how far they are from the truth, as baked.
#include "baker/pack/character/tier_pack.hpp"

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

namespace {

struct TierOps {
  uint64_t extrapolation, modal, network;
};

TierOps ops_of(const TierWork& work) {
  // A node's share: its damped coordinates; its frame, drive, terms and warp, which are scalar code: so many
  // multiply-adds of the kernels take as long.
  constexpr uint64_t kExtrapolationOps = 3, kModalOps = 3000, kRodSegmentOps = 30000;
  constexpr uint64_t kStrandLanes = 4;  // of the vectors that a strand by itself fills a lane of
  const uint64_t rods = work.rods.segments * kRodSegmentOps + work.rods.network_multiply_adds * kStrandLanes;
  const uint64_t modal = work.nodes * kModalOps + rods + work.mode_floats;
  return {work.nodes * kExtrapolationOps, modal, modal + work.network_multiply_adds};
}

pack::TierRecord record_of(Tier tier, uint32_t level, uint64_t ops, float ratio = kNotMeasured) {
  return {.tier = static_cast<uint32_t>(tier),
          .cost_us = cost_us(ops),
          .cost_p99_us = kNotMeasured,
          .error_mm = kNotMeasured,
          .error_ratio = ratio,
          .error_p95_mm = kNotMeasured,
          .level = level,
          .worst_error_ratio = kNotMeasured,
          .worst_clip = pack::kNoIndex};
}

}  // namespace

std::vector<pack::TierRecord> make_tiers(std::span<const TierWork> work) {
  std::vector<TierOps> ops;
  for (const TierWork& level : work) ops.push_back(ops_of(level));
  std::vector<pack::TierRecord> tiers = {record_of(Tier::kSkinning, 0, 0, 1),
                                         record_of(Tier::kExtrapolate, 0, ops[0].extrapolation)};
  if (work[0].network_multiply_adds > 0) {
    for (uint32_t l = 0; l < ops.size(); ++l) tiers.push_back(record_of(Tier::kNetwork, l, ops[l].network));
  }
  for (uint32_t l = 0; l < ops.size(); ++l) tiers.push_back(record_of(Tier::kModal, l, ops[l].modal));
  return tiers;
}

}  // namespace sinew::baker

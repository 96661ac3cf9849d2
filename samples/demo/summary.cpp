// summary.cpp  see summary.hpp.
#include "samples/demo/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::demo {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Coarser graphs follow the finest.
bool is_measured(const CharacterFile& character, Tier tier) {
  return std::ranges::any_of(character.view.tiers, [&](const pack::TierRecord& record) {
    return record.tier == static_cast<uint32_t>(tier) && record.level == 0 && !std::isnan(record.error_ratio);
  });
}

template <class Get>
StageTime stage(const Run& run, const char* name, const Get& get) {
  return {name, spread_of(column(run.frames, get))};
}

TierShare tier_share(const Run& run, const CharacterFile& character, Tier tier, const char* name,
                     uint32_t FrameReport::*instances) {
  double sum = 0;
  for (const FrameRecord& frame : run.frames) sum += frame.step.*instances;
  TierShare out{name, tier, sum / (run.instances * static_cast<double>(run.frames.size())), kUnknown,
                kUnknown};
  for (const pack::TierRecord& record : character.view.tiers) {
    if (record.tier != static_cast<uint32_t>(tier) || record.level != 0) continue;
    out.baked_cost_us = static_cast<double>(record.cost_us);
    out.baked_error_mm = static_cast<double>(record.error_mm);
  }
  return out;
}

std::vector<ReasonShare> reason_shares(const Run& run) {
  constexpr const char* kNames[kTierReasonCount] = {"best", "budget", "held",  "turn", "waiting",
                                                    "cut",  "hidden", "guard", "still"};
  std::vector<ReasonShare> out;
  const double all = run.instances * static_cast<double>(run.frames.size());
  for (size_t r = 0; r < kTierReasonCount; ++r)
    if (run.reasons[r] > 0) out.push_back({kNames[r], static_cast<double>(run.reasons[r]) / all});
  return out;
}

Spread unspent_of(const Run& run) {
  std::vector<double> shares;
  for (const FrameRecord& frame : run.frames)
    if (frame.step.unspent_us > 0)
      shares.push_back(static_cast<double>(frame.step.unspent_us / frame.step.budget_us));
  return spread_of(std::move(shares));
}

// The runtime goes on with usual errors where none was baked: those are not this character's.
std::optional<Spread> expected_error(const Run& run, const CharacterFile& character,
                                     const std::vector<TierShare>& shares) {
  for (const TierShare& share : shares) {
    const bool is_simulated = share.tier >= Tier::kNetwork;
    if (share.share > 0 && is_simulated && !is_measured(character, share.tier)) return std::nullopt;
  }
  const std::vector<double> errors =
      column(run.frames, [](const FrameRecord& f) { return f.step.expected_error; });
  if (std::ranges::any_of(errors, [](double error) { return std::isnan(error); })) return std::nullopt;
  return spread_of(errors);
}

}  // namespace

RodWork rod_work(const Run& run) {
  std::vector<double> iterations, residuals;
  for (const FrameRecord& frame : run.frames) {
    if (frame.first.rod_iterations == 0) continue;
    iterations.push_back(static_cast<double>(frame.first.rod_iterations) / run.asset.rod_count);
    residuals.push_back(static_cast<double>(frame.first.rod_residual));
  }
  return {spread_of(std::move(iterations)), spread_of(std::move(residuals))};
}

Summary summarise(const Run& run, const CharacterFile& character) {
  Summary out;
  out.step = {stage(run, "schedule", [](const FrameRecord& f) { return f.step.schedule_us; }),
              stage(run, "drive", [](const FrameRecord& f) { return f.step.drive_us; }),
              stage(run, "tissue", [](const FrameRecord& f) { return f.step.tissue_us; }),
              stage(run, "rods", [](const FrameRecord& f) { return f.step.rods_us; }),
              stage(run, "publish", [](const FrameRecord& f) { return f.step.publish_us; }),
              stage(run, "whole step", [](const FrameRecord& f) { return f.step.total_us; })};
  out.engine = {stage(run, "set poses", [](const FrameRecord& f) { return f.poses_us; }),
                stage(run, "read positions", [](const FrameRecord& f) { return f.read_us; })};
  out.tiers = {
      tier_share(run, character, Tier::kNetwork, "network", &FrameReport::instances_network),
      tier_share(run, character, Tier::kModal, "modal", &FrameReport::instances_modal),
      tier_share(run, character, Tier::kExtrapolate, "extrapolated", &FrameReport::instances_extrapolated),
      tier_share(run, character, Tier::kSkinning, "skinning", &FrameReport::instances_skinned)};
  for (const TierShare& tier : out.tiers) {
    if (tier.share > 0) out.expected_error_mm += tier.share * tier.baked_error_mm;
  }
  out.reasons = reason_shares(run);
  out.unspent = unspent_of(run);
  out.expected_error = expected_error(run, character, out.tiers);
  for (const FrameRecord& frame : run.frames) {
    out.over_budget += frame.step.over_budget;
    out.cut += frame.step.instances_cut;
    out.rejected_poses += frame.step.rejected_poses;
    out.dropped_s += static_cast<double>(frame.step.dropped_s);
  }
  out.rods = rod_work(run);
  out.restarts = run.restarts;
  out.input_clamps = run.input_clamps;
  out.displacement_clamps = run.displacement_clamps;
  out.skinning_error_mm =
      spread_of(column(run.frames, [](const FrameRecord& f) { return f.error.skinning_mm; }));
  out.sinew_error_mm = spread_of(column(run.frames, [](const FrameRecord& f) { return f.error.sinew_mm; }));
  return out;
}

}  // namespace sinew::demo

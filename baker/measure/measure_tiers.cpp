// measure_tiers.cpp  see measure_tiers.hpp.
#include "baker/measure/measure_tiers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/common/on_all_cores.hpp"
#include "baker/measure/yardstick.hpp"
#include "baker/truth/motion/motion.hpp"
#include "baker/truth/motion/pick_clips.hpp"
#include "baker/truth/trajectory.hpp"

namespace sinew::baker {
namespace {

constexpr uint64_t kSeed = 9100;  // no plan of the trainer reaches it
constexpr double kStrength = 0.3, kLasts_s = 1.5, kLessLasts_s = 0.85;
constexpr long kLargeBody = 2000;  // free nodes of the cage; from there on fewer ticks keep a bake short

struct NamedMotion {
  std::string name;
  Motion motion;
  uint32_t clip = pack::kNoIndex;
};

std::vector<NamedMotion> motions_of(const Character& character) {
  constexpr size_t kMostClips = 5;
  std::vector<NamedMotion> motions = {{"random", random_motion(character, kSeed, kStrength)}};
  for (const size_t c : pick_clips(character, kMostClips))
    motions.push_back({"clip:" + character.clips[c].name, clip_motion(character, character.clips[c]),
                       static_cast<uint32_t>(c)});
  if (motions.size() == 1) motions.push_back({"shake", shake_motion(character)});
  return motions;
}

// Keeps the furthest that a control node of each region has been from its skinned place, in radii.
void note_moved(const TissueLayout& layout, const TruthFrame& frame, std::vector<double>& radii) {
  for (const ControlNode& node : layout.nodes) {
    const auto v = static_cast<size_t>(node.vertex), r = static_cast<size_t>(node.region);
    radii[r] = std::max(radii[r], (frame.truth[v] - frame.skinned[v]).norm() / layout.regions[r].radius_m);
  }
}

// NaN of none.
float median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return std::numeric_limits<float>::quiet_NaN();
  std::ranges::sort(values);
  const size_t half = values.size() / 2;
  return static_cast<float>(values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2);
}

}  // namespace

ShortTruths short_truths(const Character& character, const TissueLayout& layout, const Recipe& recipe,
                         const std::vector<ModalBasis>& modes, const pack::PackView& pack) {
  const std::vector<NamedMotion> motions = motions_of(character);
  const double rate_hz = static_cast<double>(pack.network->rate_hz);
  const int substeps = usual_substeps(modes, rate_hz);
  const auto most_ticks = static_cast<size_t>(std::lround(kLasts_s * rate_hz));
  std::vector<Safetensors> files(motions.size());
  std::vector<std::vector<double>> moved(motions.size(), std::vector<double>(layout.regions.size(), 0));
  const auto simulate = [&](size_t m, std::atomic<size_t>& done) {
    TissueTruth truth(character, layout, recipe);
    const bool large = std::ranges::count(truth.cage().constrained, false) > kLargeBody;
    const auto ticks = static_cast<size_t>(std::lround((large ? kLessLasts_s : kLasts_s) * rate_hz));
    TrajectoryRecorder recorder(character, layout, {.rate_hz = rate_hz, .positions = true}, modes);
    recorder.add(truth.start(motions[m].motion));
    for (size_t tick = 1; tick <= ticks; ++tick) {
      try {
        const TruthFrame frame = truth.advance(rate_hz, substeps);
        note_moved(layout, frame, moved[m]);
        recorder.add(frame);
      } catch (const std::runtime_error& fault) {
        throw std::runtime_error(motions[m].name + ": " + fault.what());
      }
      ++done;
    }
    files[m] =
        recorder.finish({{"motion", motions[m].name}, {"rate_hz", std::to_string(std::lround(rate_hz))}});
    files[m].path = character.name + ": truth of " + motions[m].name;
    done += most_ticks - ticks;
  };
  on_all_cores("truth", motions.size() * most_ticks, motions.size(), simulate);
  ShortTruths truths;
  truths.moved_radii.assign(layout.regions.size(), 0);
  for (size_t m = 0; m < motions.size(); ++m) {
    truths.surfaces.emplace_back(files[m], pack);
    truths.clips.push_back(motions[m].clip);
    for (size_t r = 0; r < moved[m].size(); ++r)
      truths.moved_radii[r] = std::max(truths.moved_radii[r], moved[m][r]);
    files[m] = {};  // all of them are large
  }
  return truths;
}

std::vector<pack::TierRecord> measured_tiers(const LoadedPack& character, const ShortTruths& truths) {
  const Yardstick yardstick(character, truths.surfaces);
  std::vector<pack::TierRecord> tiers(character.view().tiers.begin(), character.view().tiers.end());
  for (pack::TierRecord& tier : tiers) {
    const auto kind = static_cast<Tier>(tier.tier);
    const Error error = kind == Tier::kSkinning      ? yardstick.of_skinning()
                        : kind == Tier::kExtrapolate ? yardstick.of_extrapolation(character, kCarriedTicks)
                                                     : yardstick.of(character, kind, tier.level);
    tier.error_mm = static_cast<float>(error.mean_mm);
    tier.error_ratio = median(error.ratios);
    tier.error_p95_mm = static_cast<float>(error.p95_mm);
    if (kind == Tier::kSkinning) continue;
    const auto worst = std::ranges::max_element(error.ratios, {},
                                                [](double ratio) { return std::isnan(ratio) ? -1 : ratio; });
    tier.worst_error_ratio = static_cast<float>(*worst);
    tier.worst_clip = truths.clips[static_cast<size_t>(worst - error.ratios.begin())];
  }
  return tiers;
}

double error_ratio_of(const std::vector<pack::TierRecord>& tiers, Tier tier) {
  for (const pack::TierRecord& record : tiers)
    if (record.tier == static_cast<uint32_t>(tier) && record.level == 0)
      return static_cast<double>(record.error_ratio);
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace sinew::baker

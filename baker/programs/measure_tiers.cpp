// measure_tiers.cpp  see measure_tiers.hpp.
#include "baker/programs/measure_tiers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/common/on_all_cores.hpp"
#include "baker/programs/yardstick.hpp"
#include "baker/truth/motion.hpp"
#include "baker/truth/trajectory.hpp"

namespace sinew::baker {
namespace {

constexpr uint64_t kSeed = 9100;  // no plan of the trainer reaches it
constexpr double kStrength = 0.3, kLasts_s = 1.5, kLessLasts_s = 0.85;
constexpr const char* kClipPrefix = "clip:";
constexpr long kLargeBody = 2000;  // free nodes of the cage; from there on fewer ticks keep a bake short

// Of its joints, by a thousandth of how far they are apart.
bool moves(const Character& character, const Clip& clip) {
  constexpr int kSamples = 12;
  constexpr double kHardly = 1e-3;
  const std::vector<Matrix4> first = joint_matrices(character, &clip, 0);
  double reach = 0, moved = 0;
  for (const Matrix4& joint : first)
    reach = std::max(reach, (joint - first[0]).topRightCorner<3, 1>().norm());
  for (int i = 1; i <= kSamples; ++i) {
    const std::vector<Matrix4> now = joint_matrices(character, &clip, clip.duration_s * i / kSamples);
    for (size_t j = 0; j < first.size(); ++j)
      moved = std::max({moved, (now[j] - first[j]).topRightCorner<3, 1>().norm(),
                        reach * (now[j] - first[j]).topLeftCorner<3, 3>().norm()});
  }
  return moved > kHardly * reach;
}

struct NamedMotion {
  std::string name;
  Motion motion;
};

std::vector<NamedMotion> motions_of(const Character& character) {
  constexpr size_t kMostClips = 5;
  std::vector<NamedMotion> motions = {{"random", random_motion(character, kSeed, kStrength)}};
  std::vector<const Clip*> clips;
  for (const Clip& clip : character.clips)
    if (moves(character, clip)) clips.push_back(&clip);
  if (clips.empty()) motions.push_back({"shake", shake_motion(character)});
  const size_t picked = std::min(kMostClips, clips.size());
  for (size_t k = 0; k < picked; ++k) {
    const Clip& clip = *clips[picked == 1 ? 0 : k * (clips.size() - 1) / (picked - 1)];
    motions.push_back({kClipPrefix + clip.name, clip_motion(character, clip)});
  }
  return motions;
}

float median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::ranges::sort(values);
  const size_t half = values.size() / 2;
  return static_cast<float>(values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2);
}

uint32_t clip_of(const pack::PackView& view, const std::string& motion) {
  for (uint32_t c = 0; c < view.clips.size(); ++c)
    if (motion == kClipPrefix + std::string(pack::string_at(view, view.clips[c].name))) return c;
  return pack::kNoIndex;
}

}  // namespace

std::vector<TrueSurface> short_truths(const Character& character, const TissueLayout& layout,
                                      const Recipe& recipe, const std::vector<ModalBasis>& modes,
                                      const pack::PackView& pack) {
  const std::vector<NamedMotion> motions = motions_of(character);
  const double rate_hz = static_cast<double>(pack.network->rate_hz);
  const int substeps = usual_substeps(modes, rate_hz);
  std::vector<Safetensors> files(motions.size());
  const auto simulate = [&](size_t m, std::atomic<size_t>& done) {
    TissueTruth truth(character, layout, recipe);
    const bool large = std::ranges::count(truth.cage().constrained, false) > kLargeBody;
    const auto ticks = static_cast<size_t>(std::lround((large ? kLessLasts_s : kLasts_s) * rate_hz));
    TrajectoryRecorder recorder(character, layout, {.rate_hz = rate_hz, .positions = true}, modes);
    recorder.add(truth.start(motions[m].motion));
    for (size_t tick = 1; tick <= ticks; ++tick) {
      recorder.add(truth.advance(rate_hz, substeps));
      ++done;
    }
    files[m] =
        recorder.finish({{"motion", motions[m].name}, {"rate_hz", std::to_string(std::lround(rate_hz))}});
    files[m].path = character.name + ": truth of " + motions[m].name;
  };
  const auto most_ticks = static_cast<size_t>(std::lround(kLasts_s * rate_hz));
  on_all_cores("truth", motions.size() * most_ticks, motions.size(), simulate);
  std::vector<TrueSurface> truths;
  for (const Safetensors& file : files) truths.emplace_back(file, pack);
  return truths;
}

std::vector<pack::TierRecord> measured_tiers(const LoadedPack& character,
                                             const std::vector<TrueSurface>& truths) {
  const Yardstick yardstick(character, truths);
  std::vector<pack::TierRecord> tiers(character.view().tiers.begin(), character.view().tiers.end());
  for (pack::TierRecord& tier : tiers) {
    const auto kind = static_cast<Tier>(tier.tier);
    const Error error = kind == Tier::kSkinning      ? yardstick.of_skinning()
                        : kind == Tier::kExtrapolate ? yardstick.of_extrapolation(character, kCarriedTicks)
                                                     : yardstick.of(character, kind, tier.every, tier.level);
    tier.error_mm = static_cast<float>(error.mean_mm);
    tier.error_ratio = median(error.ratios);
    tier.error_p95_mm = static_cast<float>(error.p95_mm);
    if (kind == Tier::kSkinning) continue;
    const auto worst = std::ranges::max_element(error.ratios, {},
                                                [](double ratio) { return std::isnan(ratio) ? -1 : ratio; });
    tier.worst_error_ratio = static_cast<float>(*worst);
    tier.worst_clip =
        clip_of(character.view(), truths[static_cast<size_t>(worst - error.ratios.begin())].name());
  }
  return tiers;
}

double error_ratio_of(const std::vector<pack::TierRecord>& tiers, Tier tier) {
  for (const pack::TierRecord& record : tiers)
    if (record.tier == static_cast<uint32_t>(tier) && record.level == 0 && record.every == 1)
      return static_cast<double>(record.error_ratio);
  return std::numeric_limits<double>::quiet_NaN();
}

bool network_pays(const std::vector<pack::TierRecord>& tiers) {
  return error_ratio_of(tiers, Tier::kNetwork) < (1 - kNetworkMargin) * error_ratio_of(tiers, Tier::kModal);
}

}  // namespace sinew::baker

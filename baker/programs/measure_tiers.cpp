// measure_tiers.cpp  see measure_tiers.hpp.
#include "baker/programs/measure_tiers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/common/progress.hpp"
#include "baker/programs/yardstick.hpp"
#include "baker/truth/motion.hpp"
#include "baker/truth/trajectory.hpp"

namespace sinew::baker {
namespace {

constexpr uint64_t kSeed = 9100;  // no plan of the trainer reaches it
constexpr double kStrength = 0.3, kLasts_s = 1.5, kLessLasts_s = 0.85;
constexpr long kLargeBody = 2000;  // free nodes of the cage; from there on fewer ticks keep a bake short

// How far joints move in a clip, as mean speed.
double motion_of(const Character& character, const Clip& clip) {
  constexpr int kSamples = 12;
  double sum = 0;
  std::vector<Matrix4> before;
  for (int i = 0; i <= kSamples; ++i) {
    const std::vector<Matrix4> now = joint_matrices(character, &clip, clip.duration_s * i / kSamples);
    for (size_t j = 0; j < before.size(); ++j) sum += (now[j] - before[j]).topRightCorner<3, 1>().norm();
    before = now;
  }
  return clip.duration_s > 0 ? sum / clip.duration_s : 0;
}

const Clip* liveliest(const Character& character) {
  const auto most = std::ranges::max_element(character.clips, {},
                                             [&](const Clip& clip) { return motion_of(character, clip); });
  return most == character.clips.end() ? nullptr : &*most;
}

struct NamedMotion {
  std::string name;
  Motion motion;
};

std::vector<NamedMotion> motions_of(const Character& character) {
  std::vector<NamedMotion> motions = {{"random", random_motion(character, kSeed, kStrength)}};
  if (const Clip* clip = liveliest(character))
    motions.push_back({"clip:" + clip->name, clip_motion(character, *clip)});
  else
    motions.push_back({"shake", shake_motion(character)});
  return motions;
}

}  // namespace

std::vector<TrueSurface> short_truths(const Character& character, const TissueLayout& layout,
                                      const std::vector<ModalBasis>& modes, TissueTruth& truth,
                                      const pack::PackView& pack) {
  const std::vector<NamedMotion> motions = motions_of(character);
  const bool large = std::ranges::count(truth.cage().constrained, false) > kLargeBody;
  const double rate_hz = static_cast<double>(pack.network->rate_hz);
  const auto ticks = static_cast<size_t>(std::lround((large ? kLessLasts_s : kLasts_s) * rate_hz));
  const int substeps = usual_substeps(modes, rate_hz);
  Progress progress("truth", motions.size() * ticks);
  std::vector<TrueSurface> truths;
  for (const NamedMotion& motion : motions) {
    TrajectoryRecorder recorder(character, layout, {.rate_hz = rate_hz, .positions = true}, modes);
    recorder.add(truth.start(motion.motion));
    for (size_t tick = 1; tick <= ticks; ++tick) {
      recorder.add(truth.advance(rate_hz, substeps));
      progress.update(truths.size() * ticks + tick);
    }
    Safetensors file =
        recorder.finish({{"motion", motion.name}, {"rate_hz", std::to_string(std::lround(rate_hz))}});
    file.path = character.name + ": truth of " + motion.name;
    truths.emplace_back(file, pack);
  }
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
    tier.error_ratio = static_cast<float>(error.ratio);
    tier.error_p95_mm = static_cast<float>(error.p95_mm);
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

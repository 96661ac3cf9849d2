// clip_frequency.cpp  Each control node as an oscillator that hangs on its skinned place.
#include "baker/mesh/clip_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace sinew::baker {
namespace {

constexpr double kTick_s = 1.0 / 60, kMostOfClip_s = 10;
constexpr double kMostAtLimit = 0.1;                   // of the ticks
constexpr double kStep = 1.1, kMostFrequency_hz = 25;  // of the search; what a recipe may state

using Matrix3X = Eigen::Matrix3Xd;  // of a region: a node

// What a tick of a clip adds to flesh's acceleration against its skinned place: [tick], m/s^2.
using Shake = std::vector<Matrix3X>;

Matrix3X skinned_nodes(const TissueLayout& layout, const Region& region, const std::vector<Matrix4>& skin) {
  Matrix3X places = Matrix3X::Zero(3, region.node_count);
  for (int n = 0; n < region.node_count; ++n) {
    const ControlNode& node = layout.nodes[static_cast<size_t>(region.first_node + n)];
    for (size_t k = 0; k < kInfluences; ++k)
      if (node.skin.weight[k] > 0)
        places.col(n) +=
            node.skin.weight[k] *
            (skin[static_cast<size_t>(node.skin.joint[k])] * node.position.homogeneous()).head<3>();
  }
  return places;
}

// Weight as the turned flesh feels it, less what it bears in the bind pose.
Vector3 weight_change(const Matrix4& skin) {
  constexpr double kGravity_m_s2 = 9.81;
  const Vector3 down = -kGravity_m_s2 * Vector3::UnitY();
  return down - skin.topLeftCorner<3, 3>().colwise().normalized() * down;
}

// Of each region, clip after clip.
std::vector<std::vector<Shake>> shakes_of(const Character& character, const TissueLayout& layout) {
  std::vector<std::vector<Shake>> shakes(layout.regions.size());
  for (const Clip& clip : character.clips) {
    const long ticks = std::lround(std::min(clip.duration_s, kMostOfClip_s) / kTick_s);
    std::vector<std::vector<Matrix3X>> places(layout.regions.size());
    for (auto& of_region : shakes) of_region.emplace_back();
    for (long t = 0; t <= ticks; ++t) {
      std::vector<Matrix4> skin = joint_matrices(character, &clip, static_cast<double>(t) * kTick_s);
      for (size_t j = 0; j < skin.size(); ++j) skin[j] *= character.inverse_bind[j];
      for (size_t r = 0; r < layout.regions.size(); ++r) {
        const Region& region = layout.regions[r];
        std::vector<Matrix3X>& past = places[r];
        past.push_back(skinned_nodes(layout, region, skin));
        if (t < 2) continue;
        const size_t last = past.size() - 1;
        const Matrix3X acceleration =
            (past[last] - 2 * past[last - 1] + past[last - 2]) / (kTick_s * kTick_s);
        shakes[r].back().push_back((-acceleration).colwise() +
                                   weight_change(skin[static_cast<size_t>(region.frame_joint)]));
      }
    }
  }
  return shakes;
}

// x'' = -w^2 x - 2 z w x' + shake, exact over a tick in which the shake is constant.
class Oscillators {
 public:
  Oscillators(double frequency_hz, double damping_ratio, int nodes)
      : x_(Matrix3X::Zero(3, nodes)), v_(Matrix3X::Zero(3, nodes)) {
    constexpr double kMostDamping = 0.95;  // the formula is of what swings
    const double w = 2 * std::numbers::pi * frequency_hz, z = std::min(damping_ratio, kMostDamping);
    const double damped = w * std::sqrt(1 - z * z), fade = std::exp(-z * w * kTick_s);
    const double c = fade * std::cos(damped * kTick_s), s = fade * std::sin(damped * kTick_s) / damped;
    square_ = w * w;
    xx_ = c + z * w * s, xv_ = s;
    vx_ = -square_ * s, vv_ = c - z * w * s;
  }

  void step(const Matrix3X& shake) {
    const Matrix3X rest = shake / square_, y = x_ - rest, v = v_;
    x_ = rest + xx_ * y + xv_ * v;
    v_ = vx_ * y + vv_ * v;
  }
  double largest_m() const { return x_.colwise().norm().maxCoeff(); }

 private:
  Matrix3X x_, v_;
  double square_, xx_, xv_, vx_, vv_;
};

// The share of the clips' ticks in which the region, swinging at this frequency, is beyond its limit.
double share_at_limit(const std::vector<Shake>& clips, const Region& region, double frequency_hz) {
  const double limit_m = region.max_displacement * region.radius_m;
  size_t ticks = 0, beyond = 0;
  for (const Shake& clip : clips) {
    Oscillators flesh(frequency_hz, region.damping_ratio, region.node_count);
    for (const Matrix3X& shake : clip) {
      flesh.step(shake);
      beyond += region.intensity * flesh.largest_m() > limit_m;
    }
    ticks += clip.size();
  }
  return ticks > 0 ? static_cast<double>(beyond) / static_cast<double>(ticks) : 0;
}

std::string note_on(const Region& region, double fits_hz, double share) {
  char text[240];
  std::snprintf(
      text, sizeof text,
      region.states_frequency
          ? "'%s' stands at its limit in %.0f %% of its clips' ticks: at its frequency_hz of %.2g it is "
            "too soft for them; %.2g would do"
          : "'%s' would stand at its limit in %.0f %% of its clips' ticks at the usual %.2g Hz: it "
            "swings at %.2g; state frequency_hz to have it softer",
      region.name.c_str(), 100 * share, region.frequency_hz, fits_hz);
  return text;
}

}  // namespace

void fit_frequencies(Character& character, TissueLayout& layout) {
  const std::vector<std::vector<Shake>> shakes = shakes_of(character, layout);
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    Region& region = layout.regions[r];
    if (!(region.frequency_hz > 0)) continue;
    const double share = share_at_limit(shakes[r], region, region.frequency_hz);
    if (share <= kMostAtLimit) continue;
    double fits_hz = region.frequency_hz;
    while (fits_hz < kMostFrequency_hz && share_at_limit(shakes[r], region, fits_hz) > kMostAtLimit)
      fits_hz = std::min(kStep * fits_hz, kMostFrequency_hz);
    character.notes.push_back(note_on(region, fits_hz, share));
    if (!region.states_frequency) region.frequency_hz = fits_hz;
  }
}

}  // namespace sinew::baker

// clip_frequency.cpp  Each control node as an oscillator that hangs on its skinned place.
#include "baker/mesh/regions/clip_frequency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace sinew::baker {
namespace {

constexpr double kTick_s = 1.0 / 60, kMostOfClip_s = 4;
constexpr double kSettled_s = 2;      // a clip is repeated so long before it counts
constexpr double kMostAtLimit = 0.1;  // of the ticks
constexpr double kStep = 1.1;         // of the search
constexpr int kMostNodes = 40;        // of a region

using Matrix3X = Eigen::Matrix3Xf;  // of a region: a node

// What a tick of a clip adds to flesh's acceleration against its skinned place: [tick], m/s^2.
using Shake = std::vector<Matrix3X>;

Eigen::Matrix3Xd skinned_nodes(const TissueLayout& layout, const Region& region,
                               const std::vector<Matrix4>& skin) {
  const int step = (region.node_count + kMostNodes - 1) / kMostNodes;
  Eigen::Matrix3Xd places = Eigen::Matrix3Xd::Zero(3, (region.node_count + step - 1) / step);
  for (int n = 0; n < places.cols(); ++n) {
    const ControlNode& node = layout.nodes[static_cast<size_t>(region.first_node + n * step)];
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
    std::vector<std::array<Eigen::Matrix3Xd, 3>> places(layout.regions.size());  // newest first
    for (auto& of_region : shakes) of_region.emplace_back();
    for (long t = 0; t <= ticks; ++t) {
      std::vector<Matrix4> skin = joint_matrices(character, &clip, static_cast<double>(t) * kTick_s);
      for (size_t j = 0; j < skin.size(); ++j) skin[j] *= character.inverse_bind[j];
      for (size_t r = 0; r < layout.regions.size(); ++r) {
        const Region& region = layout.regions[r];
        std::array<Eigen::Matrix3Xd, 3>& past = places[r];
        std::rotate(past.begin(), past.begin() + 2, past.end());
        past[0] = skinned_nodes(layout, region, skin);
        if (t < 2) continue;
        const Eigen::Matrix3Xd acceleration = (past[0] - 2 * past[1] + past[2]) / (kTick_s * kTick_s);
        const Vector3 weight = weight_change(skin[static_cast<size_t>(region.frame_joint)]);
        shakes[r].back().push_back(((-acceleration).colwise() + weight).cast<float>());
      }
    }
  }
  return shakes;
}

// x'' = -w^2 x - 2 z w x' + shake, exact over a tick in which the shake is constant.
class Oscillators {
 public:
  Oscillators(double frequency_hz, double damping_ratio, Eigen::Index nodes)
      : x_(Matrix3X::Zero(3, nodes)), v_(Matrix3X::Zero(3, nodes)) {
    constexpr double kMostDamping = 0.95;  // the formula is of what swings
    const double w = 2 * std::numbers::pi * frequency_hz, z = std::min(damping_ratio, kMostDamping);
    const double damped = w * std::sqrt(1 - z * z), fade = std::exp(-z * w * kTick_s);
    const double c = fade * std::cos(damped * kTick_s), s = fade * std::sin(damped * kTick_s) / damped;
    square_ = static_cast<float>(w * w);
    xx_ = static_cast<float>(c + z * w * s), xv_ = static_cast<float>(s);
    vx_ = static_cast<float>(-w * w * s), vv_ = static_cast<float>(c - z * w * s);
  }

  void step(const Matrix3X& shake) {
    const Matrix3X rest = shake / square_, y = x_ - rest, v = v_;
    x_ = rest + xx_ * y + xv_ * v;
    v_ = vx_ * y + vv_ * v;
  }
  double largest_m() const { return static_cast<double>(x_.colwise().norm().maxCoeff()); }

 private:
  Matrix3X x_, v_;
  float square_, xx_, xv_, vx_, vv_;
};

// The share of the clips' ticks in which the region, swinging at this frequency, is beyond its limit.
double share_at_limit(const std::vector<Shake>& clips, const Region& region, double frequency_hz) {
  const double limit_m = region.max_displacement * region.radius_m;
  size_t ticks = 0, beyond = 0;
  for (const Shake& clip : clips) {
    if (clip.empty()) continue;
    Oscillators flesh(frequency_hz, region.damping_ratio, clip.front().cols());
    const auto repeats = static_cast<int>(kSettled_s / (static_cast<double>(clip.size()) * kTick_s)) + 1;
    for (int pass = 0; pass <= repeats; ++pass)
      for (const Matrix3X& shake : clip) {
        flesh.step(shake);
        beyond += pass == repeats && region.intensity * flesh.largest_m() > limit_m;
      }
    ticks += clip.size();
  }
  return ticks > 0 ? static_cast<double>(beyond) / static_cast<double>(ticks) : 0;
}

// To two figures, as notes print it: who states what a note says is not told so again.
double rounded_up(double frequency_hz) {
  const double unit = std::pow(10, std::floor(std::log10(frequency_hz)) - 1);
  return std::min(std::ceil(frequency_hz / unit - 1e-9) * unit, kMostFrequency_hz);
}

// The lowest of the search that lets the region swing; the highest where none does.
double fitting_hz(const std::vector<Shake>& clips, const Region& region) {
  double fits_hz = rounded_up(region.frequency_hz);
  while (fits_hz < kMostFrequency_hz && share_at_limit(clips, region, fits_hz) > kMostAtLimit)
    fits_hz = rounded_up(kStep * fits_hz);
  return fits_hz;
}

std::string note_on(const Region& region, double share, double fits_hz, bool fits) {
  char text[240];
  if (!region.states_frequency)
    std::snprintf(text, sizeof text,
                  "'%s' would be at its limit in %.0f %% of its clips' ticks at the usual %.2g Hz: it swings "
                  "at %.2g; state frequency_hz to have it softer",
                  region.name.c_str(), 100 * share, region.frequency_hz, fits_hz);
  else
    std::snprintf(text, sizeof text,
                  "'%s' is at its limit in %.0f %% of its clips' ticks: its frequency_hz of %.2g is too soft "
                  "for them; %s %.2g would do",
                  region.name.c_str(), 100 * share, region.frequency_hz, fits ? "from" : "not even", fits_hz);
  return text;
}

}  // namespace

void fit_frequencies(Character& character, TissueLayout& layout) {
  const auto swings = [](const Region& region) { return region.frequency_hz > 0; };
  if (character.clips.empty() || std::ranges::none_of(layout.regions, swings)) return;
  const std::vector<std::vector<Shake>> shakes = shakes_of(character, layout);
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    Region& region = layout.regions[r];
    if (!swings(region)) continue;
    const double share = share_at_limit(shakes[r], region, region.frequency_hz);
    if (share <= kMostAtLimit) continue;
    const double fits_hz = fitting_hz(shakes[r], region);
    const bool fits = share_at_limit(shakes[r], region, fits_hz) <= kMostAtLimit;
    character.notes.push_back(note_on(region, share, fits_hz, fits));
    if (!region.states_frequency) region.frequency_hz = fits_hz;
  }
}

}  // namespace sinew::baker

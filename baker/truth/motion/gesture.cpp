// gesture.cpp  Smooth steps of the root and the joints: dashes, turns, tilts, and leaps made of them.
#include "baker/truth/motion/gesture.hpp"

#include <algorithm>
#include <array>

#include "baker/truth/motion/local_pose.hpp"

namespace sinew::baker {
namespace {

constexpr double kEasePeak = 10 / std::numbers::sqrt3;  // largest second derivative of ease()
constexpr double kMostStrike_rad = 0.6;                 // of a joint, in one phase of a leap

double share(const Gesture& g, double t_s) {
  const double there = ease((t_s - g.start_s) / g.length_s);
  return g.back_s > 0 ? there - ease((t_s - g.back_s) / g.length_s) : there;
}

// Phases of a leap; each step begins before the last one ends, so that speed is carried through.
enum Phase { kCrouch, kThrow, kFall, kCatch, kPhases };
constexpr double kOverlap = 1.35;  // length of a step / time between starts

struct Timing {
  std::array<double, kPhases> start_s, length_s;
  double end_s;
};

Timing draw_timing(Random& random, double start_s) {
  Timing timing{};
  double t = start_s;
  for (int phase = 0; phase < kPhases; ++phase) {
    const double apart = random.uniform(0.1, 0.3);
    timing.start_s[phase] = t;
    timing.length_s[phase] = kOverlap * apart;
    t += apart;
  }
  timing.end_s = t;
  return timing;
}

// What a leap comes to at the end of each phase, as a share of its height.
std::array<double, kPhases> draw_heights(Random& random) {
  return {-random.uniform(0, 0.4), 1, -random.uniform(0, 0.4), 0};
}

double log_uniform(Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform(0, 1));
}

void draw_flight(Random& random, const Timing& timing, double strength, RootGestures* root) {
  const std::array<double, kPhases> heights = draw_heights(random);
  const Vector3 direction = random.chance(0.6) ? Vector3(0, 1, 0) : random.direction();
  const double shortest = std::min(timing.length_s[kThrow], timing.length_s[kFall]);
  const double height = log_uniform(random, 8, 50) * strength * shortest * shortest / kEasePeak;
  double before = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    const Vector3 change = (heights[phase] - before) * height * direction;
    root->dashes.push_back({timing.start_s[phase], timing.length_s[phase], 0, change});
    before = heights[phase];
  }
}

void draw_lean(Random& random, const Timing& timing, double strength, RootGestures* root) {
  Vector3 before = Vector3::Zero();
  for (int phase = 0; phase < kPhases; ++phase) {
    const Vector3 now =
        phase == kCatch ? Vector3(0, 0, 0) : Vector3(random.uniform(0, 0.15) * strength * random.direction());
    root->tilts.push_back({timing.start_s[phase], timing.length_s[phase], 0, now - before});
    before = now;
  }
}

Vector3 draw_strike(Random& random, double length_s, double strength) {
  const double angle = log_uniform(random, 4, 40) * strength * length_s * length_s / kEasePeak;
  return std::min(angle, kMostStrike_rad) * random.direction();
}

// A pose; a joint follows its parent's or strikes its own, or stays.
std::vector<Vector3> draw_pose(Random& random, const std::vector<int>& joint_parent, double length_s,
                               double strength) {
  std::vector<Vector3> pose(joint_parent.size(), Vector3::Zero());
  for (size_t j = 0; j < pose.size(); ++j) {
    const int parent = joint_parent[j];
    if (parent >= 0 && random.chance(0.5))
      pose[j] = random.uniform(0.5, 1) * pose[static_cast<size_t>(parent)];
    else if (random.chance(0.5))
      pose[j] = draw_strike(random, length_s, strength);
  }
  return pose;
}

void draw_strikes(Random& random, const Timing& timing, double strength, const std::vector<int>& joint_parent,
                  JointGestures* joints) {
  std::vector<Vector3> before(joint_parent.size(), Vector3::Zero());
  for (int phase = 0; phase < kPhases; ++phase) {
    std::vector<Vector3> now = draw_pose(random, joint_parent, timing.length_s[phase], strength);
    if (phase == kCatch) now.assign(now.size(), Vector3::Zero());
    for (size_t j = 0; j < now.size(); ++j)
      (*joints)[j].push_back({timing.start_s[phase], timing.length_s[phase], 0, now[j] - before[j]});
    before = now;
  }
}

}  // namespace

void put_in_order(std::vector<Gesture>* gestures) {
  std::ranges::stable_sort(*gestures, {}, &Gesture::start_s);
}

Vector3 sum_of(const std::vector<Gesture>& gestures, double t_s) {
  Vector3 sum = Vector3::Zero();
  for (const Gesture& g : gestures) {
    if (g.start_s > t_s) break;
    sum += share(g, t_s) * g.change;
  }
  return sum;
}

void draw_gestures(Random& random, double start_s, double end_s, double strength, RootGestures* root) {
  for (double t = start_s + random.uniform(0, 0.4); t < end_s; t += random.uniform(0.4, 1.5)) {
    const double length = random.uniform(0.25, 0.7);
    if (random.chance(0.6)) {  // a step, or a hop that comes back
      const double acceleration = 3 * std::pow(10, random.uniform(0, 1)) * strength;
      const double distance = acceleration * length * length / kEasePeak;
      const Vector3 direction = random.chance(0.5) ? random.direction() : Vector3(0, random.sign(), 0);
      root->dashes.push_back({t, length, random.chance(0.5) ? t + length : 0, distance * direction});
    }
    if (random.chance(0.4)) {
      const double angle = std::min(1.6, random.uniform(8, 50) * strength * length * length / kEasePeak);
      root->turns.push_back({t, length, 0, Vector3(0, random.sign() * angle, 0)});
    }
    if (random.chance(0.3)) {
      const double angle = std::min(0.9, random.uniform(5, 40) * strength * length * length / kEasePeak);
      root->tilts.push_back({t, length, t + length + random.uniform(0, 1.0), angle * random.direction()});
    }
  }
}

void draw_leaps(Random& random, double start_s, double end_s, double strength,
                const std::vector<int>& joint_parent, RootGestures* root, JointGestures* joints) {
  for (double t = start_s + random.uniform(0, 0.3); t < end_s;) {
    const Timing timing = draw_timing(random, t);
    draw_flight(random, timing, strength, root);
    draw_lean(random, timing, strength, root);
    draw_strikes(random, timing, strength, joint_parent, joints);
    t = timing.end_s + random.uniform(0, 0.5);
  }
}

}  // namespace sinew::baker

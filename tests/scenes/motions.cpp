// motions.cpp  How the soft block is moved.
#include "tests/scenes/motions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::scenes {
namespace {

double wave(double frequency_hz, double time_s) {
  return std::sin(2 * std::numbers::pi * frequency_hz * time_s);
}

// From 0 to 1 in the first second, with continuous acceleration.
double ease_in(double time_s) {
  const double t = std::clamp(time_s, 0.0, 1.0);
  return t * t * t * (10 - 15 * t + 6 * t * t);
}

}  // namespace

BlockPose bent_pose(double bend_rad, double x_m, double heading_rad) {
  const auto c = static_cast<float>(std::cos(bend_rad)), s = static_cast<float>(std::sin(bend_rad));
  const auto waist = static_cast<float>(kBlockJointHeight_m);
  BlockPose pose;
  pose.joints[0] = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  pose.joints[1] = {{{c, -s, 0, 0}, {s, c, 0, waist}, {0, 0, 1, 0}}};
  pose.root.position_m[0] = x_m;
  pose.root.rotation_xyzw[1] = static_cast<float>(std::sin(heading_rad / 2));
  pose.root.rotation_xyzw[3] = static_cast<float>(std::cos(heading_rad / 2));
  return pose;
}

BlockPose bind_pose() { return bent_pose(0); }

BlockPose walk(double time_s) {
  const double gain = ease_in(time_s);
  const double x_m = gain * (1.2 * time_s + 0.05 * wave(1.5, time_s));
  BlockPose pose = bent_pose(gain * 0.3 * wave(1.1, time_s), x_m, gain * 0.8 * wave(0.5, time_s));
  pose.root.position_m[1] = gain * 0.03 * wave(1.4, time_s);
  return pose;
}

BlockPose shake(double time_s, double strength) {
  const double gain = strength * ease_in(time_s);
  return bent_pose(gain * 0.15 * wave(3, time_s), gain * 0.03 * wave(3, time_s + 0.05));
}

}  // namespace sinew::scenes

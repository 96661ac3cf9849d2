// motions.hpp  How the soft block is moved: poses as smooth functions of time.
#pragma once
#include <array>

#include "sinew/types.hpp"

namespace sinew::scenes {

inline constexpr double kBlockJointHeight_m = 0.3;

// Owns the joints that a sinew::Pose looks at.
struct BlockPose {
  std::array<Matrix34, 2> joints{};
  RootTransform root;
  Pose pose() const { return {joints, root}; }
};

BlockPose bind_pose();
// Upper joint bent about z by bend_rad; root at x_m, turned about y by heading_rad.
BlockPose bent_pose(double bend_rad, double x_m = 0, double heading_rad = 0);

// Walks along x, sways and turns at rates of 0.5 .. 1.5 Hz, with soft starts: about 10 m/s^2 at most.
BlockPose walk(double time_s);
// Rocks the root and the upper joint at 3 Hz: near the tissue's resonance.
BlockPose shake(double time_s, double strength = 1);

}  // namespace sinew::scenes

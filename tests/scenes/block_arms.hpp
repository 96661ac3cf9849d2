// block_arms.hpp  Arms for the soft block: bones beside it, without skin, with capsules about them.
#pragma once
#include <array>
#include <vector>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "tests/scenes/motions.hpp"

namespace sinew::scenes {

inline constexpr double kArmRadius_m = 0.05, kArmHeight_m = 0.5;

// Each is a bone across x at a place of its own, its capsule along z from one side of the block to the other.
// The last joints.
struct ArmMatter {
  std::vector<double> at_x_m = {0.3};
  double height_m = kArmHeight_m;
  double radius_m = kArmRadius_m;
  bool waist_too = false;    // a capsule a centimetre beside the block, of the waist, behind the arms
  bool touches_body = true;  // of all regions
};

void add_arms(const ArmMatter& matter, baker::Character& character, baker::TissueLayout& layout);

// The first arm moved along x and turned about y.
struct ArmedPose {
  std::vector<Matrix34> joints;
  RootTransform root;
  Pose pose() const { return {joints, root}; }
};
ArmedPose with_arms(const BlockPose& block, const ArmMatter& matter, double way_m, double turn_rad = 0);
// All arms moved up, beside other joints.
ArmedPose with_raised_arms(const Pose& pose, const ArmMatter& matter, double up_m);

}  // namespace sinew::scenes

// clip.hpp  Clips of a recipe as keys: tracks summed, limbs solved, rotations sampled.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "baker/creature/creature_recipe.hpp"

namespace sinew::baker {

struct JointKeys {  // a key a time, the last equal to the first
  int joint = 0;
  std::vector<Eigen::Quaterniond> rotation;  // empty: stays at rest
  std::vector<Eigen::Vector3d> translation;  // parent-relative; empty: stays at rest
};

struct ClipKeys {
  std::string name;
  std::vector<double> times_s;
  std::vector<JointKeys> joints;
};

// Index of a joint that the reader has checked to exist.
int joint_index(const CreatureRecipe& recipe, const std::string& name);

// Where a joint stands relative to its parent in the rest pose.
Eigen::Vector3d rest_offset(const CreatureRecipe& recipe, int joint);

ClipKeys key_clip(const CreatureRecipe& recipe, const ClipRecipe& clip);

}  // namespace sinew::baker

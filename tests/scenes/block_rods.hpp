// block_rods.hpp  A tail and two horns for the soft block, as rods, and poses that have them.
#pragma once
#include <array>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "tests/scenes/motions.hpp"

namespace sinew::scenes {

// Joints 2 to 5 are the tail, from the waist's back straight back; 6 to 8 and 9 to 11 are horns, from the
// waist's sides upwards and outwards. A bone is kBone_m long and carries a ring of four vertices at each end.
inline constexpr double kBone_m = 0.1;
inline constexpr uint32_t kTail = 2, kHorns[] = {6, 9}, kTailedJoints = 12;

struct RodMatter {
  double gravity = 1, sag = 0;
  double young_modulus_pa = 1e6;
  double max_displacement = 0;
  bool sewn = false;     // the ends of the tail and of the first horn are held by joint 0
  bool learned = false;  // the tail starts from a network's guess: BlockOptions::rod_weights
  bool bar = false;      // a capsule across and below the tail, that moves with the waist
};

inline constexpr double kBarRadius_m = 0.03, kTailRadius_m = 0.02;
// Of the bar's axis, bind pose.
baker::Vector3 bar_end(double side);

void add_rods(const RodMatter& matter, baker::Character& character, baker::TissueLayout& layout);

struct TailedPose {
  std::array<Matrix34, kTailedJoints> joints{};
  RootTransform root;
  Pose pose() const { return {joints, root}; }
};

// Each bone of the tail turned by wag_rad about the one before it.
TailedPose with_rods(const BlockPose& block, double wag_rad = 0);

}  // namespace sinew::scenes

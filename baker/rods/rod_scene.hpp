// rod_scene.hpp  Random rods of the kinds that Shao et al. 2021 (Table 1) learn from, and how they are held.
#pragma once
#include <string>
#include <vector>

#include "rods/rod_batch.hpp"
#include "rods/strand.hpp"
#include "rods/turn.hpp"

namespace sinew::baker {

enum class RodKind { kBendingRod, kHelix, kTree };
// Throws BadInput naming `place` for a name that is none of bending_rod, helix, tree.
RodKind rod_kind(const std::string& name, const std::string& place);

// What a scene is drawn from; both ends of a range are possible.
struct RodRange {
  RodKind kind = RodKind::kBendingRod;
  double least_segments = 10, most_segments = 100;  // 2 .. 2000; of a tree: of each of its rods
  double softest_pa = 1e4, stiffest_pa = 1e9;       // > 0; Young's modulus, log-uniform; torsion's apart
  int rods = 1;                                     // 1 .. 1000, of a tree
};

// Where the held root is at a time; the first pose is the one at rest.
class RootMotion {
 public:
  RootMotion() = default;
  // Up to `reach_m` and some 45 degrees away by sines of 0.2 to 2 Hz. Half of all roots rest; of the others a
  // third moves only 25 times a second, as an animation does that is played as it was sampled.
  RootMotion(const rods::SegmentDef& root, double reach_m, uint64_t seed);
  rods::SegmentPose at(double time_s) const;

 private:
  struct Wave {
    double direction[3], axis[3], reach_m, angle_rad, rate, phase;
  };
  rods::SegmentPose start_{};
  std::vector<Wave> waves_;
  double hold_s_ = 0;
};

struct RodScene {
  std::vector<rods::SegmentDef> segments;  // the root is fixed
  RootMotion motion;
};

// The same bits for the same seed. Length 0.2 to 4 m, radius 1/1000 to 1/50 of it, density 200 to 3000
// kg/m^3, drag 0 to 1 /s, half of them damped, turned any way; a helix curves and twists by the same turn at
// every joint, a tree's rods sit anywhere on those before them and grow thinner.
RodScene make_rod_scene(const RodRange& range, uint64_t seed);

}  // namespace sinew::baker

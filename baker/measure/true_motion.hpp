// true_motion.hpp  A trajectory of `sinew-bake truth` as a character meets it: poses in, true displacement
// out.
#pragma once
#include <span>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "pack/reader.hpp"
#include "sinew/types.hpp"

namespace sinew::baker {

// Throws BadInput: not a trajectory of this version, of another character (joints, control nodes, and where
// they rest), or of another rate.
void check_trajectory_of(const Safetensors& file, const pack::PackView& character);

// T ticks after the start; immutable. What a character may not move beyond its regions' limits, its truth may
// not either: each region's displacement is scaled as the runtime scales what it shows
// (tissue/modes/guard.hpp), so that an error tells of the simulation and not of an artist's choice.
class TrueMotion {
 public:
  // Throws BadInput as check_trajectory_of does; and: shorter than one tick, not finite.
  TrueMotion(const Safetensors& file, const pack::PackView& character);

  size_t ticks() const { return roots_.size() - 1; }
  std::span<const Matrix34> joints(size_t tick) const;  // character-from-joint
  const RootTransform& root(size_t tick) const { return roots_[tick]; }
  // [nodes][3], metres along each node's frame.
  const float* displacement(size_t tick) const { return &displacement_[tick * 3 * nodes_]; }
  // What the region's true displacement was scaled by, 1 where it is within its limit.
  float limited(size_t tick, size_t region) const { return limited_[tick * region_count_ + region]; }

 private:
  void limit(const pack::PackView& character);

  size_t nodes_, joint_count_, region_count_;
  std::vector<Matrix34> joints_;
  std::vector<RootTransform> roots_;
  std::vector<float> displacement_, limited_;
};

}  // namespace sinew::baker

// true_motion.hpp  A trajectory of `sinew-bake truth` as a character meets it: poses in, true displacement
// out.
#pragma once
#include <span>
#include <vector>

#include "baker/common/safetensors.hpp"
#include "pack/reader.hpp"
#include "sinew/types.hpp"

namespace sinew::baker {

// Throws BadInput: not a trajectory of this version, of another character (joints, control nodes, and where
// they rest), or of another rate.
void check_trajectory_of(const Safetensors& file, const pack::PackView& character);

// T ticks after the start; immutable.
class TrueMotion {
 public:
  // Throws BadInput as check_trajectory_of does; and: shorter than one tick, not finite.
  TrueMotion(const Safetensors& file, const pack::PackView& character);

  size_t ticks() const { return roots_.size() - 1; }
  std::span<const Matrix34> joints(size_t tick) const;  // character-from-joint
  const RootTransform& root(size_t tick) const { return roots_[tick]; }
  // [nodes][3], metres along each node's frame.
  const float* displacement(size_t tick) const { return &displacement_[tick * 3 * nodes_]; }

 private:
  size_t nodes_, joint_count_;
  std::vector<Matrix34> joints_;
  std::vector<RootTransform> roots_;
  std::vector<float> displacement_;
};

}  // namespace sinew::baker

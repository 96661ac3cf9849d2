// true_surface.hpp  A trajectory of `sinew-bake truth --positions`: poses in, and where every vertex truly
// is.
#pragma once
#include <string>
#include <vector>

#include "baker/measure/true_motion.hpp"

namespace sinew::baker {

class TrueSurface {
 public:
  // Throws BadInput as TrueMotion does; and: without positions, not finite.
  TrueSurface(const std::string& path, const pack::PackView& character);
  TrueSurface(const Safetensors& file, const pack::PackView& character);

  const std::string& name() const { return name_; }  // of the motion, as its file states it
  const TrueMotion& motion() const { return motion_; }
  // [vertices][3], metres, character space.
  const float* positions(size_t tick) const { return &positions_[tick * 3 * vertices_]; }
  uint64_t fingerprint() const;

 private:
  std::string name_;
  size_t vertices_;
  TrueMotion motion_;
  std::vector<float> positions_;
};

}  // namespace sinew::baker

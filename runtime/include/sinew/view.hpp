// view.hpp  Where a world is seen from. What no view shows is not simulated, and what is far matters less.
#pragma once
#include <cstdint>
#include <limits>

#include "sinew/export.h"

namespace sinew {

// A camera, or a light whose shadows show the characters.
struct View {
  double position_m[3] = {0, 0, 0};       // of the eye, in the world; within +-1e12, else refused
  float rotation_xyzw[4] = {0, 0, 0, 1};  // world-from-camera, looking along -Z, Y up; zero length: refused
  float height_rad = 1;      // the angle from its lower to its upper edge; > 0, < pi, else refused
  float aspect = 16.0f / 9;  // width over height; > 0, finite, else refused
  float far_m =
      std::numeric_limits<float>::infinity();  // what is wholly beyond is not shown; > 0, else refused
};

inline constexpr uint32_t kMostViews = 8;

// The door for an engine's own geometry: sinew::Occluders (occluders.hpp) is one such implementation. Called
// on the stepping thread; may not throw, allocate or block.
class SINEW_API OcclusionSource {
 public:
  virtual ~OcclusionSource() = default;
  // Whether something that hides characters lies between two points of the world.
  virtual bool is_blocked(const double (&from_m)[3], const double (&to_m)[3]) noexcept = 0;
};

}  // namespace sinew

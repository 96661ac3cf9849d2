// turning_camera.cpp  see turning_camera.hpp.
#include "samples/demo/turning_camera.hpp"

#include <cmath>
#include <numbers>

namespace sinew::demo {

View turning_camera(double t_s, double height_m, double spacing_m) {
  constexpr double kEyes = 0.9, kBefore = 3, kWidest_rad = 0.42, kPeriod_s = 8;
  constexpr float kHeight_rad = 0.6f;
  const double half_yaw = kWidest_rad / 2 * std::sin(2 * std::numbers::pi * t_s / kPeriod_s);
  return {
      .position_m = {0, kEyes * height_m, kBefore * spacing_m},
      .rotation_xyzw = {0, static_cast<float>(std::sin(half_yaw)), 0, static_cast<float>(std::cos(half_yaw))},
      .height_rad = kHeight_rad};
}

}  // namespace sinew::demo

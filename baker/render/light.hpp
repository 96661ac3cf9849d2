// light.hpp  The studio every picture is taken in: a large warm key light, a cool sky, a light from behind, a
// pale floor.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>

#include "baker/render/picture/color.hpp"

namespace sinew::render {

struct Studio {
  // Directions point towards the light. The key is a disc seen under this half angle: soft shadow edges.
  Eigen::Vector3f key_direction = Eigen::Vector3f(-0.56f, 0.66f, 0.50f).normalized();
  float key_half_angle_rad = 0.15f;
  Rgb key{1.02f, 0.95f, 0.84f};  // what a white surface sends back when it faces the light
  Eigen::Vector3f rim_direction = Eigen::Vector3f(0.74f, 0.42f, -0.60f).normalized();
  Rgb rim{0.50f, 0.62f, 0.85f};
  Rgb sky_zenith{0.45f, 0.52f, 0.64f};
  Rgb sky_horizon{0.52f, 0.53f, 0.55f};
  Rgb bounce{0.34f, 0.31f, 0.29f};  // what the floor throws back up

  Rgb floor{0.60f, 0.62f, 0.66f};  // as seen, in full light
  Rgb floor_line{0.47f, 0.50f, 0.55f};
  Rgb backdrop{0.70f, 0.74f, 0.80f};  // at the horizon; the floor fades into it
  Rgb backdrop_top{0.36f, 0.44f, 0.56f};

  // The lights go round with the camera: every side of a character is lit alike.
  static Studio facing(float yaw_deg) {
    const Eigen::AngleAxisf turn(yaw_deg * 0.017453293f, Eigen::Vector3f::UnitY());
    Studio studio;
    studio.key_direction = turn * studio.key_direction;
    studio.rim_direction = turn * studio.rim_direction;
    return studio;
  }

  Rgb sky(const Eigen::Vector3f& direction) const {
    const float up = std::clamp(direction.y(), -1.0f, 1.0f);
    if (up < 0) return sky_horizon + std::sqrt(-up) * (bounce - sky_horizon);
    return sky_horizon + std::sqrt(up) * (sky_zenith - sky_horizon);
  }
};

}  // namespace sinew::render

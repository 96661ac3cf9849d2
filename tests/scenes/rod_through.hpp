// rod_through.hpp  A chain through given points, and points on a coil.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <vector>

#include "math/turn_between.hpp"
#include "rods/strand.hpp"

namespace sinew::test {

// A segment between each two points, each turned from the one before by the smallest turn there is: no twist
// at rest. All else as `like` has it.
inline std::vector<rods::SegmentDef> rod_through(std::span<const Eigen::Vector3d> points,
                                                 const rods::SegmentDef& like) {
  std::vector<rods::SegmentDef> out;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  for (uint32_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector3d along = points[i + 1] - points[i], middle = 0.5 * (points[i] + points[i + 1]);
    turn = (core::turn_between(turn * Eigen::Vector3d::UnitZ(), along) * turn).normalized();
    rods::SegmentDef s = like;
    for (int k = 0; k < 3; ++k) s.position_m[k] = middle[k];
    for (int k = 0; k < 4; ++k) s.orientation[k] = static_cast<float>(turn.coeffs()[k]);
    s.length_m = static_cast<float>(along.norm());
    s.parent = i == 0 ? rods::kNoParent : i - 1;
    out.push_back(s);
  }
  return out;
}

struct CoilShape {
  uint32_t segments = 120;
  double turns = 6, radius_m = 0.12, pitch_m = 0.06;  // pitch: from turn to turn
};

// About z from the origin on, turned by `turn` and moved to `place_m`.
inline std::vector<Eigen::Vector3d> coil(const CoilShape& shape, const Eigen::Quaterniond& turn,
                                         const Eigen::Vector3d& place_m) {
  std::vector<Eigen::Vector3d> out;
  for (uint32_t i = 0; i <= shape.segments; ++i) {
    const double turns = shape.turns * i / shape.segments, angle = 2 * M_PI * turns;
    const Eigen::Vector3d point(shape.radius_m * std::cos(angle), shape.radius_m * std::sin(angle),
                                shape.pitch_m * (turns - 0.5 * shape.turns));
    out.push_back(place_m + turn * point);
  }
  return out;
}

}  // namespace sinew::test

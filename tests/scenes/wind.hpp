// wind.hpp  A gusting wind and what it does to rods.
//
// Drag of a long body across its axis: with u the air's velocity less the segment's, and of it only what is
// across the segment's axis,
//   f = k u,   k = rho / 2 c w l |u|
// rho 1.2 kg/m^3, c 1.1 (a rough cylinder), w the width that meets the air: twice the radius and what leaves
// add. It is taken at the end of the step as far as one segment alone can tell, f = k u / (1 + h k / m), so
// that a twig never overshoots the air that carries it, however light it is.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <span>

#include "rods/rod_batch.hpp"
#include "rods/section.hpp"

namespace sinew::test {

struct Wind {
  Eigen::Vector3d direction{1, 0, 0};  // unit
  double mean_m_s = 7, gust_m_s = 8;   // speed of the mean, and of what gusts add to it or take from it
  double rise_s = 1.5;                 // from calm to this at the start
};

inline constexpr double kAir_kg_m3 = 1.2, kDragCoefficient = 1.1;

// Gusts travel downwind with the mean speed: the tree's far side feels them later.
inline Eigen::Vector3d wind_at(const Wind& wind, const Eigen::Vector3d& place_m, double time_s) {
  const double t = time_s - place_m.dot(wind.direction) / std::max(wind.mean_m_s, 0.1);
  const auto wave = [t](double hz, double phase) { return std::sin(2 * M_PI * hz * t + phase); };
  const double gust = 0.55 * wave(0.21, 4.2) + 0.3 * wave(0.53, 1.1) + 0.15 * wave(1.31, 2.3);
  const double rise = std::clamp(time_s / wind.rise_s, 0.0, 1.0);
  const double speed = std::max(0.0, rise * rise * (3 - 2 * rise) * (wind.mean_m_s + wind.gust_m_s * gust));
  const Eigen::Vector3d across = wind.direction.cross(Eigen::Vector3d::UnitY());
  return speed * (wind.direction + 0.18 * wave(0.37, 0.4) * across +
                  0.10 * wave(0.83, 5.0) * Eigen::Vector3d::UnitY());
}

// On a segment in air that moves with `air_m_s`.
inline Eigen::Vector3d drag_n(const rods::SegmentDef& segment, double width_m, const rods::SegmentPose& pose,
                              const rods::SegmentVelocity& velocity, const Eigen::Vector3d& air_m_s,
                              double dt_s) {
  const float* q = pose.orientation;
  const Eigen::Vector3d axis =
      Eigen::Quaternionf(q[3], q[0], q[1], q[2]).cast<double>().normalized() * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d u = air_m_s - Eigen::Vector3f(velocity.linear_m_s).cast<double>();
  u -= u.dot(axis) * axis;
  const double k =
      0.5 * kAir_kg_m3 * kDragCoefficient * width_m * static_cast<double>(segment.length_m) * u.norm();
  return k / (1 + dt_s * k / rods::segment_inertia(segment).mass_kg) * u;
}

// Gives every segment that is not fixed its drag for the coming step. widths_m: one a segment.
inline void blow(rods::RodBatch& batch, uint32_t strand, std::span<const rods::SegmentDef> segments,
                 std::span<const double> widths_m, const Wind& wind, double time_s, double dt_s) {
  for (uint32_t i = 0; i < segments.size(); ++i) {
    if (segments[i].fixed) continue;
    const rods::SegmentPose pose = batch.pose(strand, i);
    const Eigen::Vector3d air = wind_at(wind, Eigen::Vector3d(pose.position_m), time_s);
    const Eigen::Vector3f force =
        drag_n(segments[i], widths_m[i], pose, batch.velocity(strand, i), air, dt_s).cast<float>();
    (void)batch.set_force(strand, i, {force.x(), force.y(), force.z()});
  }
}

}  // namespace sinew::test

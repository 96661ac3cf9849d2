// body_field.hpp  The body as an implicit surface: smooth unions and cuts of ellipsoids and tubes, negative
// inside.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "baker/creature/creature_recipe.hpp"

namespace sinew::baker {

struct FieldSample {
  double distance = 0;  // metres, to first order
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitY();
  double edge_scale = 1;
};

class SolidField {  // one primitive, ready to be evaluated
 public:
  explicit SolidField(const Solid& solid);
  FieldSample sample(const Eigen::Vector3d& point) const;
  double distance_at_least(const Eigen::Vector3d& point) const { return (point - center_).norm() - reach_m_; }
  Eigen::AlignedBox3d bounds() const;

 private:
  struct Cone {  // hull of two spheres
    Eigen::Vector3d from, along;
    double length, radius, radius_gain, slope;
  };
  FieldSample sample_ellipsoid(const Eigen::Vector3d& point) const;
  FieldSample sample_tube(const Eigen::Vector3d& point) const;
  Eigen::Vector3d stretched(const Eigen::Vector3d& v) const {
    return v + stretch_ * flat_axis_.dot(v) * flat_axis_;
  }

  Eigen::Vector3d center_, radii_, flat_axis_;
  Eigen::Matrix3d local_from_body_;
  double reach_m_ = 0, stretch_ = 0;
  std::vector<Cone> cones_;  // in stretched space
};

class BodyField {
 public:
  explicit BodyField(const std::vector<BodyPart>& parts);
  FieldSample sample(const Eigen::Vector3d& point) const;
  Eigen::Vector3d project(Eigen::Vector3d point) const;  // onto the surface, for points near it
  Eigen::AlignedBox3d bounds() const { return bounds_; }

 private:
  struct Part {
    SolidField solid;
    double blend_m, edge_scale;
    bool carve;
  };
  std::vector<Part> parts_;
  Eigen::AlignedBox3d bounds_;
};

// Place and radius at t within the span from points[span] to the next (Catmull-Rom).
Eigen::Vector4d tube_point(const std::vector<Eigen::Vector4d>& points, size_t span, double t);

Eigen::Matrix3d rotation_from_degrees(const Eigen::Vector3d& turn_deg);  // about Z, then X, then Y

}  // namespace sinew::baker

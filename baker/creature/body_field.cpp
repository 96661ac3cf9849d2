// body_field.cpp  Distances and gradients of the primitives and of their smooth union.
#include "baker/creature/body_field.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

constexpr int kConesPerSpan = 5;

// Quadratic smooth minimum; its gradient is exactly the mix of the gradients.
FieldSample smooth_union(const FieldSample& a, const FieldSample& b, double width) {
  if (width <= 0) return a.distance < b.distance ? a : b;
  const double share = std::clamp(0.5 + 0.5 * (b.distance - a.distance) / width, 0.0, 1.0);
  FieldSample mixed;
  mixed.distance = b.distance + share * (a.distance - b.distance) - width * share * (1 - share);
  mixed.gradient = b.gradient + share * (a.gradient - b.gradient);
  mixed.edge_scale = b.edge_scale + share * (a.edge_scale - b.edge_scale);
  return mixed;
}

FieldSample inverted(FieldSample sample) {
  sample.distance = -sample.distance;
  sample.gradient = -sample.gradient;
  return sample;
}

}  // namespace

Eigen::Vector4d tube_point(const std::vector<Eigen::Vector4d>& points, size_t span, double t) {
  const size_t last = points.size() - 1;
  const Eigen::Vector4d& a = points[span];
  const Eigen::Vector4d& b = points[span + 1];
  const Eigen::Vector4d tangent_a = (b - points[span == 0 ? 0 : span - 1]) * (span == 0 ? 1.0 : 0.5);
  const Eigen::Vector4d tangent_b = (points[std::min(span + 2, last)] - a) * (span + 1 == last ? 1.0 : 0.5);
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * tangent_a + (3 * t2 - 2 * t3) * b +
         (t3 - t2) * tangent_b;
}

Eigen::Matrix3d rotation_from_degrees(const Eigen::Vector3d& turn_deg) {
  const Eigen::Vector3d angle = turn_deg * (M_PI / 180);
  return (Eigen::AngleAxisd(angle.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angle.x(), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(angle.z(), Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

SolidField::SolidField(const Solid& solid)
    : center_(solid.at),
      radii_(solid.radii),
      flat_axis_(solid.flat_axis.normalized()),
      local_from_body_(rotation_from_degrees(solid.turn_deg).transpose()),
      reach_m_(solid.radii.maxCoeff()),
      stretch_(1 / solid.flat - 1) {
  if (solid.points.empty()) return;
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector4d> rings;
  for (size_t span = 0; span + 1 < solid.points.size(); ++span)
    for (int i = 0; i < kConesPerSpan; ++i)
      rings.push_back(tube_point(solid.points, span, static_cast<double>(i) / kConesPerSpan));
  rings.push_back(solid.points.back());
  for (const Eigen::Vector4d& ring : rings) box.extend(Eigen::Vector3d(ring.head<3>()));
  center_ = box.center();
  reach_m_ = 0;
  for (const Eigen::Vector4d& ring : rings)
    reach_m_ = std::max(reach_m_, (ring.head<3>() - center_).norm() + ring.w());
  for (size_t i = 0; i + 1 < rings.size(); ++i) {
    const Eigen::Vector3d from = stretched(rings[i].head<3>()), to = stretched(rings[i + 1].head<3>());
    const double length = (to - from).norm(), gain = rings[i + 1].w() - rings[i].w();
    const double sine = std::clamp(gain / std::max(length, 1e-9), -0.95, 0.95);
    cones_.push_back({from, (to - from) / std::max(length, 1e-9), length, rings[i].w(), gain,
                      sine / std::sqrt(1 - sine * sine)});
  }
}

Eigen::AlignedBox3d SolidField::bounds() const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m_);
  return {Eigen::Vector3d(center_ - reach), Eigen::Vector3d(center_ + reach)};
}

FieldSample SolidField::sample(const Eigen::Vector3d& point) const {
  return cones_.empty() ? sample_ellipsoid(point) : sample_tube(point);
}

FieldSample SolidField::sample_ellipsoid(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d local = local_from_body_ * (point - center_);
  const Eigen::Vector3d once = local.cwiseQuotient(radii_), twice = once.cwiseQuotient(radii_);
  const double k0 = once.norm(), k1 = std::max(twice.norm(), 1e-9);
  FieldSample sample;
  if (k0 < 1e-6) {
    sample.distance = -radii_.minCoeff();
    return sample;
  }
  sample.distance = k0 * (k0 - 1) / k1;
  const Eigen::Vector3d fourth = twice.cwiseQuotient(radii_).cwiseQuotient(radii_);
  const Eigen::Vector3d gradient =
      twice * ((2 * k0 - 1) / (k0 * k1)) - fourth * (k0 * (k0 - 1) / (k1 * k1 * k1));
  sample.gradient = local_from_body_.transpose() * gradient;
  return sample;
}

FieldSample SolidField::sample_tube(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = stretched(point);
  FieldSample nearest;
  nearest.distance = 1e9;
  for (const Cone& cone : cones_) {
    const Eigen::Vector3d offset = p - cone.from;
    const double axial = offset.dot(cone.along);
    const double radial = std::sqrt(std::max(0.0, offset.squaredNorm() - axial * axial));
    const double along = std::clamp(axial + radial * cone.slope, 0.0, cone.length);
    const Eigen::Vector3d out = offset - along * cone.along;
    const double reach = out.norm();
    const double radius = cone.radius + cone.radius_gain * (cone.length > 0 ? along / cone.length : 0);
    if (reach - radius >= nearest.distance) continue;
    nearest.distance = reach - radius;
    nearest.gradient = reach > 1e-9 ? Eigen::Vector3d(out / reach) : flat_axis_;
  }
  nearest.gradient = stretched(nearest.gradient);
  const double steepness = nearest.gradient.norm();
  nearest.distance /= steepness;
  nearest.gradient /= steepness;
  return nearest;
}

BodyField::BodyField(const std::vector<BodyPart>& parts) {
  for (const BodyPart& part : parts) {
    parts_.push_back({SolidField(part.solid), part.blend_m, part.edge_scale, part.carve});
    if (!part.carve) bounds_.extend(parts_.back().solid.bounds());
  }
}

FieldSample BodyField::sample(const Eigen::Vector3d& point) const {
  FieldSample body;
  body.distance = 1e9;
  for (const Part& part : parts_) {
    if (part.solid.distance_at_least(point) > std::abs(body.distance) + part.blend_m) continue;
    FieldSample solid = part.solid.sample(point);
    solid.edge_scale = part.edge_scale;
    body = part.carve ? inverted(smooth_union(inverted(body), solid, part.blend_m))
                      : smooth_union(body, solid, part.blend_m);
  }
  return body;
}

Eigen::Vector3d BodyField::project(Eigen::Vector3d point) const {
  constexpr int kNewtonSteps = 8;
  constexpr double kOnSurface_m = 1e-6;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const FieldSample here = sample(point);
    if (std::abs(here.distance) < kOnSurface_m) break;
    const double steepness = std::max(here.gradient.squaredNorm(), 0.25);
    const Eigen::Vector3d move = here.gradient * (here.distance / steepness);
    point -= move * std::min(1.0, 0.03 / std::max(move.norm(), 1e-12));
  }
  return point;
}

}  // namespace sinew::baker

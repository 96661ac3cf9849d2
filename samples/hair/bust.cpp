// bust.cpp  An implicit surface of tubes and ellipsoids, meshed as the demo's creature is.
#include "samples/hair/bust.hpp"

#include <algorithm>
#include <cmath>

#include "baker/creature/remesh.hpp"
#include "baker/mesh/anatomy/fit_capsule.hpp"

namespace sinew::sample {
namespace {

using baker::BodyPart;
using baker::Solid;
using Eigen::Vector3d;

constexpr double kCell_m = 0.01;
constexpr double kNeckBelow_m = 1.42, kNeckAbove_m = 1.56;  // between them the neck twists

BodyPart ellipsoid(const char* name, const Vector3d& at, const Vector3d& radii, double blend_m) {
  BodyPart part;
  part.name = name, part.solid.at = at, part.solid.radii = radii, part.blend_m = blend_m;
  return part;
}

BodyPart tube(const char* name, std::vector<Eigen::Vector4d> points, double blend_m) {
  BodyPart part;
  part.name = name, part.solid.points = std::move(points), part.blend_m = blend_m;
  return part;
}

std::vector<BodyPart> parts() {
  std::vector<BodyPart> out = {
      ellipsoid("chest", {0, 1.22, 0}, {0.16, 0.22, 0.105}, 0.02),
      tube("shoulders",
           {{-0.165, 1.385, -0.01, 0.05}, {0, 1.425, -0.015, 0.055}, {0.165, 1.385, -0.01, 0.05}}, 0.05),
      tube("neck", {{0, 1.38, -0.01, 0.06}, {0, 1.47, 0, 0.052}, {0, 1.57, 0.01, 0.052}}, 0.04),
      ellipsoid("skull", {0, 1.64, 0.005}, {0.076, 0.1, 0.095}, 0.02),
      ellipsoid("jaw", {0, 1.58, 0.035}, {0.055, 0.065, 0.06}, 0.03),
      tube("nose", {{0, 1.625, 0.098, 0.008}, {0, 1.597, 0.112, 0.011}}, 0.012)};
  for (const double side : {-1.0, 1.0}) {
    out.push_back(tube("arm",
                       {{side * 0.18, 1.375, -0.01, 0.05},
                        {side * 0.215, 1.22, -0.01, 0.043},
                        {side * 0.23, 1.08, 0, 0.038}},
                       0.03));
  }
  return out;
}

struct Bone {
  Vector3d from, to;
  double head_share;
  double distance(const Vector3d& p) const {
    const double share = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (p - from - share * (to - from)).norm();
  }
};

std::vector<Bone> bones() {
  std::vector<Bone> out = {
      {{0, 1.05, 0}, {0, 1.32, 0}, 0}, {{0, 1.44, 0}, {0, 1.53, 0}, 0.5}, {{0, 1.58, 0.01}, {0, 1.7, 0}, 1}};
  for (const double side : {-1.0, 1.0}) {
    out.push_back({{side * 0.05, 1.41, -0.01}, {side * 0.17, 1.385, -0.01}, 0});
    out.push_back({{side * 0.2, 1.3, -0.01}, {side * 0.23, 1.08, 0}, 0});
  }
  return out;
}

std::vector<BustProxy> fit_proxies(const std::vector<Vector3d>& skin) {
  const std::vector<Bone> all = bones();
  std::vector<std::vector<Vector3d>> flesh(all.size());
  for (const Vector3d& p : skin) {
    const auto nearest = std::ranges::min_element(all, {}, [&](const Bone& b) { return b.distance(p); });
    flesh[static_cast<size_t>(nearest - all.begin())].push_back(p);
  }
  std::vector<BustProxy> out;
  for (size_t b = 0; b < all.size(); ++b) {
    const baker::FittedCapsule fit = baker::fit_capsule(flesh[b], all[b].to - all[b].from);
    out.push_back({fit.from, fit.to, fit.radius_m, all[b].head_share});
  }
  return out;
}

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

double turn_share(const Vector3d& p) {
  return smooth((p.y() - kNeckBelow_m) / (kNeckAbove_m - kNeckBelow_m));
}

std::vector<float> Bust::places(const Turning& turning) const {
  std::vector<float> out;
  out.reserve(3 * rest_m.size());
  for (const Vector3d& p : rest_m) {
    const double share = turn_share(p);
    const double angle = turning.chest_rad + share * (turning.head_rad - turning.chest_rad);
    const double c = std::cos(angle), s = std::sin(angle);
    out.push_back(static_cast<float>(c * p.x() + s * p.z()));
    out.push_back(static_cast<float>(p.y()));
    out.push_back(static_cast<float>(c * p.z() - s * p.x()));
  }
  return out;
}

Bust make_bust(size_t vertices) {
  Bust out{baker::BodyField(parts()), {}, {}, {}};
  const auto distance = [&](const Vector3d& p) { return out.field.sample(p).distance; };
  const baker::Surface surface =
      baker::remesh(out.field, baker::contour(distance, out.field.bounds(), kCell_m), vertices);
  out.rest_m = surface.positions;
  out.proxies = fit_proxies(out.rest_m);
  for (const auto& t : surface.triangles) {
    out.triangles.push_back(
        {static_cast<uint32_t>(t[0]), static_cast<uint32_t>(t[1]), static_cast<uint32_t>(t[2])});
  }
  return out;
}

Turning turning_at(double time_s) {
  const double begin = smooth(time_s / 1.5);
  const double chest = begin * 0.5 * std::sin(2 * M_PI * 0.23 * time_s);
  return {chest, chest + begin * 0.9 * std::sin(2 * M_PI * 0.41 * time_s)};
}

}  // namespace sinew::sample

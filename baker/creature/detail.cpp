// detail.cpp  An ellipsoid or a cap of one, turned about its pole; rings stand where the colour changes.
#include "baker/creature/detail.hpp"

#include <algorithm>
#include <cmath>

#include "baker/creature/body_field.hpp"
#include "baker/creature/paint.hpp"

namespace sinew::baker {
namespace {

using Eigen::Vector3d;

struct Ring {
  double angle_deg;  // from the pole
  double inward;     // 1: outer face; less: the inner face of a cap
};

constexpr double kCapInnerScale = 0.93;

std::vector<double> ring_angles(size_t count, double end_deg, const std::vector<ColorBand>& bands) {
  constexpr double kFrontDenser = 1.25, kBorder_deg = 1.0;
  std::vector<double> angles;
  for (size_t i = 0; i < count; ++i)
    angles.push_back(end_deg *
                     std::pow(static_cast<double>(i + 1) / static_cast<double>(count + 1), kFrontDenser));
  size_t next = 0;
  for (const ColorBand& band : bands) {
    if (band.to_deg >= end_deg || count < 3 + 3 * bands.size()) continue;
    while (next < count && angles[next] < band.to_deg) ++next;
    if (next == 0 || next >= count) continue;
    angles[next - 1] = band.to_deg - kBorder_deg;
    angles[next] = band.to_deg + kBorder_deg;
    ++next;
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

std::vector<Ring> profile(const DetailRecipe& recipe, size_t rings) {
  std::vector<Ring> profile;
  if (recipe.cap_deg >= 180) {
    for (double angle : ring_angles(rings, 180, recipe.bands)) profile.push_back({angle, 1});
    return profile;
  }
  const size_t each_face = std::max<size_t>(1, rings / 2);
  for (size_t i = 1; i <= each_face; ++i)
    profile.push_back({recipe.cap_deg * static_cast<double>(i) / static_cast<double>(each_face), 1});
  for (size_t i = each_face; i >= 1; --i)
    profile.push_back(
        {recipe.cap_deg * static_cast<double>(i) / static_cast<double>(each_face), kCapInnerScale});
  return profile;
}

class Lathe {
 public:
  Lathe(const DetailRecipe& recipe, std::vector<Ring> rings, size_t segments)
      : recipe_(recipe),
        rings_(std::move(rings)),
        segments_(segments),
        turn_(rotation_from_degrees(recipe.solid.turn_deg)) {}

  DetailSurface run() {
    add_vertex({0, 1}, 0);
    for (const Ring& ring : rings_)
      for (size_t s = 0; s < segments_; ++s)
        add_vertex(ring, 2 * M_PI * static_cast<double>(s) / static_cast<double>(segments_));
    add_vertex(recipe_.cap_deg >= 180 ? Ring{180, 1} : Ring{0, kCapInnerScale}, 0);
    add_triangles();
    return std::move(out_);
  }

 private:
  void add_vertex(const Ring& ring, double around) {
    const double angle = ring.angle_deg * (M_PI / 180);
    const Vector3d unit(std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around),
                        std::cos(angle));
    const Vector3d normal = unit.cwiseQuotient(recipe_.solid.radii).normalized() * (ring.inward < 1 ? -1 : 1);
    out_.surface.positions.push_back(recipe_.solid.at +
                                     turn_ * (ring.inward * unit.cwiseProduct(recipe_.solid.radii)));
    out_.normals.push_back(turn_ * normal);
    out_.colors.push_back(linear_from_srgb(color_at(ring.angle_deg)));
  }

  Vector3d color_at(double angle_deg) const {
    for (const ColorBand& band : recipe_.bands)
      if (angle_deg <= band.to_deg) return band.color;
    return recipe_.bands.back().color;
  }

  int corner(size_t ring, size_t segment) const {
    return static_cast<int>(1 + ring * segments_ + segment % segments_);
  }

  void add_triangles() {
    auto& triangles = out_.surface.triangles;
    const int last = static_cast<int>(1 + rings_.size() * segments_);
    for (size_t s = 0; s < segments_; ++s) {
      triangles.push_back({0, corner(0, s), corner(0, s + 1)});
      for (size_t r = 0; r + 1 < rings_.size(); ++r) {
        triangles.push_back({corner(r, s), corner(r + 1, s), corner(r + 1, s + 1)});
        triangles.push_back({corner(r, s), corner(r + 1, s + 1), corner(r, s + 1)});
      }
      triangles.push_back({last, corner(rings_.size() - 1, s + 1), corner(rings_.size() - 1, s)});
    }
  }

  const DetailRecipe& recipe_;
  std::vector<Ring> rings_;
  size_t segments_;
  Eigen::Matrix3d turn_;
  DetailSurface out_;
};

}  // namespace

DetailSurface make_detail(const DetailRecipe& recipe, size_t vertices) {
  const double count = static_cast<double>(std::max(vertices, kFewestDetailVertices) - 2);
  const size_t segments = std::max<size_t>(5, static_cast<size_t>(std::sqrt(1.6 * count)));
  const size_t rings = std::max<size_t>(2, static_cast<size_t>(count) / segments);
  return Lathe(recipe, profile(recipe, rings), segments).run();
}

}  // namespace sinew::baker

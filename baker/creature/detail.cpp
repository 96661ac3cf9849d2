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

// A pair of rings at every change of colour, the others where the gaps are widest; the side that looks out is
// denser.
std::vector<double> ring_angles(size_t count, const std::vector<ColorBand>& bands) {
  constexpr double kBorder_deg = 0.8, kBackSparser = 2.5;
  std::vector<double> angles = {0, 180};
  for (const ColorBand& band : bands) {
    if (band.to_deg >= 180 || 2 * bands.size() > count) continue;
    angles.push_back(band.to_deg - kBorder_deg);
    angles.push_back(band.to_deg + kBorder_deg);
  }
  std::sort(angles.begin(), angles.end());
  while (angles.size() < count + 2) {
    size_t widest = 0;
    double width = 0;
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
      const double gap = (angles[i + 1] - angles[i]) / (angles[i] < 90 ? 1 : kBackSparser);
      if (gap > width) width = gap, widest = i;
    }
    angles.insert(angles.begin() + static_cast<long>(widest) + 1,
                  0.5 * (angles[widest] + angles[widest + 1]));
  }
  return {angles.begin() + 1, angles.end() - 1};
}

std::vector<Ring> profile(const DetailRecipe& recipe, size_t rings) {
  std::vector<Ring> profile;
  if (recipe.cap_deg >= 180) {
    for (double angle : ring_angles(rings, recipe.bands)) profile.push_back({angle, 1});
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

// A pole, rings of `segments` vertices, the other pole; the rings run counter-clockwise seen against the way
// to the other pole.
void add_ring_triangles(Surface& surface, size_t rings, size_t segments) {
  const auto corner = [&](size_t ring, size_t s) {
    return static_cast<int>(1 + ring * segments + s % segments);
  };
  const int last = static_cast<int>(1 + rings * segments);
  for (size_t s = 0; s < segments; ++s) {
    surface.triangles.push_back({0, corner(0, s), corner(0, s + 1)});
    for (size_t r = 0; r + 1 < rings; ++r) {
      surface.triangles.push_back({corner(r, s), corner(r + 1, s), corner(r + 1, s + 1)});
      surface.triangles.push_back({corner(r, s), corner(r + 1, s + 1), corner(r, s + 1)});
    }
    surface.triangles.push_back({last, corner(rings - 1, s + 1), corner(rings - 1, s)});
  }
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
    add_ring_triangles(out_.surface, rings_.size(), segments_);
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

  const DetailRecipe& recipe_;
  std::vector<Ring> rings_;
  size_t segments_;
  Eigen::Matrix3d turn_;
  DetailSurface out_;
};

// Rings across the tube, carried along it without twisting.
class Sweep {
 public:
  Sweep(const DetailRecipe& recipe, size_t rings, size_t segments) : segments_(segments) {
    color_ = linear_from_srgb(recipe.bands[0].color);
    const auto& points = recipe.solid.points;
    const size_t spans = points.size() - 1;
    for (size_t i = 0; i < rings; ++i) {
      const double along = static_cast<double>(i * spans) / static_cast<double>(rings - 1);
      const size_t span = std::min(static_cast<size_t>(along), spans - 1);
      path_.push_back(tube_point(points, span, along - static_cast<double>(span)));
    }
  }

  DetailSurface run() {
    Vector3d side = tangent(0).unitOrthogonal();
    add_vertex(path_[0].head<3>() - path_[0].w() * tangent(0), -tangent(0));
    for (size_t i = 0; i < path_.size(); ++i) {
      side = (side - tangent(i) * tangent(i).dot(side)).normalized();
      add_ring(path_[i], side, side.cross(tangent(i)));
    }
    const size_t end = path_.size() - 1;
    add_vertex(path_[end].head<3>() + path_[end].w() * tangent(end), tangent(end));
    add_ring_triangles(out_.surface, path_.size(), segments_);
    return std::move(out_);
  }

 private:
  Vector3d tangent(size_t i) const {
    return (path_[std::min(i + 1, path_.size() - 1)] - path_[i == 0 ? 0 : i - 1]).head<3>().normalized();
  }

  void add_ring(const Eigen::Vector4d& center, const Vector3d& side, const Vector3d& up) {
    for (size_t s = 0; s < segments_; ++s) {
      const double around = 2 * M_PI * static_cast<double>(s) / static_cast<double>(segments_);
      const Vector3d out = std::cos(around) * side + std::sin(around) * up;
      add_vertex(center.head<3>() + center.w() * out, out);
    }
  }

  void add_vertex(const Vector3d& position, const Vector3d& normal) {
    out_.surface.positions.push_back(position);
    out_.normals.push_back(normal);
    out_.colors.push_back(color_);
  }

  size_t segments_;
  Vector3d color_;
  std::vector<Eigen::Vector4d> path_;
  DetailSurface out_;
};

}  // namespace

DetailSurface make_detail(const DetailRecipe& recipe, size_t vertices) {
  const double count = static_cast<double>(std::max(vertices, kFewestDetailVertices) - 2);
  if (!recipe.solid.points.empty()) {
    const size_t segments = count < 60 ? 3 : 6;
    return Sweep(recipe, std::max<size_t>(2, static_cast<size_t>(count) / segments), segments).run();
  }
  const size_t segments = std::max<size_t>(5, static_cast<size_t>(std::sqrt(2.2 * count)));
  const size_t rings = std::max<size_t>(2, static_cast<size_t>(count) / segments);
  return Lathe(recipe, profile(recipe, rings), segments).run();
}

}  // namespace sinew::baker

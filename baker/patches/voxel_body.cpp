// voxel_body.cpp  Shapes sampled on a grid.
#include "baker/patches/voxel_body.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "baker/truth/cage/voxel_split.hpp"

namespace sinew::baker {
namespace {

using Cell = std::array<int, 3>;

struct Shape {
  std::function<bool(const Vector3&)> has;      // a place in cells
  std::function<bool(const Vector3&)> is_held;  // of places in it
  Vector3 least, most;
  double depth;
};

Shape sphere(double radius, Random& random) {
  const double core = random.uniform(0.2, 0.5) * radius;
  const Vector3 corner = Vector3::Constant(radius);
  return {[=](const Vector3& p) { return p.norm() < radius; },
          [=](const Vector3& p) { return p.norm() < std::max(core, 1.01); }, -corner, corner, radius - core};
}

Shape cylinder(double size, Random& random) {
  const double radius = size * random.uniform(0.25, 0.45);
  return {[=](const Vector3& p) { return std::hypot(p.x(), p.z()) < radius && p.y() >= 0 && p.y() < size; },
          [](const Vector3& p) { return p.y() < 0.5; }, Vector3(-radius, 0, -radius),
          Vector3(radius, size, radius), size};
}

Shape ear(double size, Random& random) {
  const double wide = size * random.uniform(0.3, 0.5), thick = std::max(1.0, size * random.uniform(0.1, 0.2));
  return {[=](const Vector3& p) {
            if (p.y() < 0 || p.y() >= size) return false;
            const double taper = std::sqrt(1 - std::pow(p.y() / size, 2));
            return std::pow(p.x() / wide, 2) + std::pow(p.z() / thick, 2) < taper * taper;
          },
          [](const Vector3& p) { return p.y() < 0.5; }, Vector3(-wide, 0, -thick), Vector3(wide, size, thick),
          size};
}

Shape slab(double size, Random& random) {
  const double x = size * random.uniform(0.8, 1.6), z = size * random.uniform(0.8, 1.6);
  return {[=](const Vector3& p) {
            const double top = size * (1 - std::pow(p.x() / x, 2) - std::pow(p.z() / z, 2));
            return p.y() >= 0 && p.y() < top;
          },
          [](const Vector3& p) { return p.y() < 0.5; }, Vector3(-x, 0, -z), Vector3(x, size, z), size};
}

Shape limb(double size, Random& random) {
  const double core = std::max(0.8, size * random.uniform(0.15, 0.4)), along = size * random.uniform(1, 2);
  const Vector3 corner(size, along, size);
  return {[=](const Vector3& p) {
            return std::hypot(p.x(), p.z()) < size * (1 - 0.3 * std::pow(p.y() / along, 2)) &&
                   std::abs(p.y()) < along;
          },
          [=](const Vector3& p) { return std::hypot(p.x(), p.z()) < core || std::abs(p.y()) > along - 0.6; },
          -corner, corner, size - core};
}

Shape make_shape(BodyShape shape, double size, Random& random) {
  switch (shape) {
    case BodyShape::kSphere:
      return sphere(size, random);
    case BodyShape::kCylinder:
      return cylinder(size, random);
    case BodyShape::kEar:
      return ear(size, random);
    case BodyShape::kSlab:
      return slab(size, random);
    case BodyShape::kLimb:
      return limb(size, random);
  }
  return sphere(size, random);
}

Vector3 at(const Cell& cell) { return {1.0 * cell[0], 1.0 * cell[1], 1.0 * cell[2]}; }

double fill_of(const Shape& shape, const Cell& cell) {
  constexpr int kFine = 4;
  int inside = 0;
  for (int k = 0; k < kFine * kFine * kFine; ++k) {
    const Vector3 fine(k % kFine + 0.5, k / kFine % kFine + 0.5, k / (kFine * kFine) + 0.5);
    inside += shape.has(at(cell) + fine / kFine);
  }
  return 1.0 * inside / (kFine * kFine * kFine);
}

class Builder {
 public:
  explicit Builder(const Shape& shape) : shape_(shape) {}

  void add(const Cell& cell) {
    constexpr double kLeastFill = 0.05;
    const double fill = fill_of(shape_, cell);
    if (fill < kLeastFill) return;
    const bool odd = (cell[0] + cell[1] + cell[2]) % 2 != 0;
    for (const std::array<int, 4>& corners : kVoxelSplit[odd ? 0 : 1]) {
      std::array<int, 4> t{};
      for (size_t c = 0; c < 4; ++c)
        t[c] =
            node({cell[0] + (corners[c] & 1), cell[1] + (corners[c] >> 1 & 1), cell[2] + (corners[c] >> 2)});
      body.tetrahedra.push_back(t);
      body.fill.push_back(fill);
    }
  }

  VoxelBody body;

 private:
  int node(const Cell& place) {
    const auto [found, is_new] = nodes_.try_emplace(place, static_cast<int>(body.nodes.size()));
    if (is_new) {
      body.nodes.push_back(at(place));
      body.constrained.push_back(shape_.is_held(at(place)));
    }
    return found->second;
  }
  const Shape& shape_;
  std::map<Cell, int> nodes_;
};

}  // namespace

VoxelBody make_body(BodyShape kind, double size, Random& random) {
  const Shape shape = make_shape(kind, size, random);
  Builder builder(shape);
  const auto first = [&](int axis) { return static_cast<int>(std::floor(shape.least[axis])); };
  const auto last = [&](int axis) { return static_cast<int>(std::ceil(shape.most[axis])); };
  for (int z = first(2); z < last(2); ++z)
    for (int y = first(1); y < last(1); ++y)
      for (int x = first(0); x < last(0); ++x) builder.add({x, y, z});
  builder.body.depth = shape.depth;
  return std::move(builder.body);
}

std::vector<std::pair<int, int>> edges_of(const std::vector<std::array<int, 4>>& tetrahedra) {
  std::vector<std::pair<int, int>> edges;
  for (const auto& t : tetrahedra)
    for (const int a : t)
      for (const int b : t)
        if (a < b) edges.emplace_back(a, b);
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace sinew::baker

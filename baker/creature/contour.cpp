// contour.cpp  Marching tetrahedra on the Kuhn subdivision of a grid (Doi and Koide 1991).
#include <algorithm>
#include <cmath>

#include "baker/creature/surface.hpp"

namespace sinew::baker {
namespace {

// Corners of a cell's six tetrahedra, all positively oriented; bit 0, 1, 2 of a corner: one step along x, y,
// z.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                   {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

// Even permutations that bring the inside corners to the front, by the mask of inside corners.
constexpr int kInsideFirst[16][4] = {{0, 1, 2, 3}, {0, 1, 2, 3}, {1, 0, 3, 2}, {0, 1, 2, 3},
                                     {2, 3, 0, 1}, {0, 2, 3, 1}, {1, 2, 0, 3}, {0, 1, 2, 3},
                                     {3, 2, 1, 0}, {0, 3, 1, 2}, {1, 3, 2, 0}, {1, 0, 3, 2},
                                     {2, 3, 0, 1}, {2, 3, 0, 1}, {3, 2, 1, 0}, {0, 1, 2, 3}};

class Contour {
 public:
  Contour(const std::function<double(const Eigen::Vector3d&)>& field, const Eigen::AlignedBox3d& box,
          double cell_m)
      : low_(box.min() - Eigen::Vector3d::Constant(1.5 * cell_m)), cell_m_(cell_m) {
    const Eigen::Vector3d size = box.max() - low_;
    for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<int>(std::ceil(size[axis] / cell_m)) + 3;
    const size_t points =
        static_cast<size_t>(count_[0]) * static_cast<size_t>(count_[1]) * static_cast<size_t>(count_[2]);
    values_.resize(points);
    for (size_t i = 0; i < points; ++i) values_[i] = field(place(i));
    vertex_of_edge_.assign(points * 8, -1);
  }

  Surface run() {
    for (int z = 0; z + 1 < count_[2]; ++z)
      for (int y = 0; y + 1 < count_[1]; ++y)
        for (int x = 0; x + 1 < count_[0]; ++x) march_cell(index(x, y, z));
    return std::move(surface_);
  }

 private:
  size_t index(int x, int y, int z) const {
    return (static_cast<size_t>(z) * static_cast<size_t>(count_[1]) + static_cast<size_t>(y)) *
               static_cast<size_t>(count_[0]) +
           static_cast<size_t>(x);
  }
  size_t step(int corner) const { return index(corner & 1, (corner >> 1) & 1, corner >> 2); }
  Eigen::Vector3d place(size_t i) const {
    const size_t nx = static_cast<size_t>(count_[0]), ny = static_cast<size_t>(count_[1]);
    return low_ + cell_m_ * Eigen::Vector3d(static_cast<double>(i % nx), static_cast<double>(i / nx % ny),
                                            static_cast<double>(i / nx / ny));
  }

  int vertex_between(size_t cell, int a, int b) {  // of two corners, one of which holds the other's bits
    const int from = a & b, direction = a ^ b;
    const size_t start = cell + step(from);
    int& vertex = vertex_of_edge_[start * 8 + static_cast<size_t>(direction)];
    if (vertex >= 0) return vertex;
    const double va = values_[start], vb = values_[start + step(direction)];
    constexpr double kOffCorner = 0.05;  // keeps triangles from shrinking to a point
    const double t = std::clamp(va / (va - vb), kOffCorner, 1 - kOffCorner);
    vertex = static_cast<int>(surface_.positions.size());
    surface_.positions.push_back((1 - t) * place(start) + t * place(start + step(direction)));
    return vertex;
  }

  void march_cell(size_t cell) {
    for (const auto& corners : kTetrahedra) {
      int mask = 0;
      for (int i = 0; i < 4; ++i) mask |= (values_[cell + step(corners[i])] < 0) << i;
      if (mask == 0 || mask == 15) continue;
      march_tetrahedron(cell, corners, mask);
    }
  }

  void march_tetrahedron(size_t cell, const int (&corners)[4], int mask) {
    const int(&order)[4] = kInsideFirst[mask];
    const int a = corners[order[0]], b = corners[order[1]], c = corners[order[2]], d = corners[order[3]];
    const auto cut = [&](int from, int to) { return vertex_between(cell, from, to); };
    const int inside = (mask & 1) + ((mask >> 1) & 1) + ((mask >> 2) & 1) + (mask >> 3);
    if (inside == 1) surface_.triangles.push_back({cut(a, b), cut(a, c), cut(a, d)});
    if (inside == 3) surface_.triangles.push_back({cut(d, a), cut(d, b), cut(d, c)});
    if (inside != 2) return;
    const int ac = cut(a, c), ad = cut(a, d), bd = cut(b, d), bc = cut(b, c);
    surface_.triangles.push_back({ac, ad, bd});
    surface_.triangles.push_back({ac, bd, bc});
  }

  Eigen::Vector3d low_;
  double cell_m_;
  int count_[3] = {};
  std::vector<double> values_;
  std::vector<int> vertex_of_edge_;
  Surface surface_;
};

}  // namespace

Surface contour(const std::function<double(const Eigen::Vector3d&)>& field, const Eigen::AlignedBox3d& box,
                double cell_m) {
  return Contour(field, box, cell_m).run();
}

}  // namespace sinew::baker

// surface.hpp  A closed triangle surface and what is asked of it.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace sinew::baker {

struct Surface {
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise from outside
};

// Empty when every edge is used once in each direction, all is one piece and there is no handle; else what is
// wrong.
std::string why_not_a_sphere(const Surface& surface);

std::vector<std::vector<int>> vertex_neighbours(const Surface& surface);  // ascending

// The zero surface of a field that is negative inside, by marching tetrahedra on a grid of cells of this
// size: closed and manifold whatever the field does, as long as the box holds it.
Surface contour(const std::function<double(const Eigen::Vector3d&)>& field, const Eigen::AlignedBox3d& box,
                double cell_m);

}  // namespace sinew::baker

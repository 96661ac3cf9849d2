// surface_point.hpp  One vertex of the soft surface at the present tick: displaced, skinned, placed.
#pragma once
#include <Eigen/Core>

#include "world/instance.hpp"
#include "world/surface_patches.hpp"

namespace sinew::world {

struct SurfacePoint {
  Eigen::Vector3f place_m;          // from the tick's root, world axes
  Eigen::Matrix3f world_from_bind;  // of a small displacement
};

// Under nodes' displacements along the axes of their flesh, [nodes][3]; instance.skin is the tick's.
SurfacePoint surface_point(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
                           const float* displacement) noexcept;

}  // namespace sinew::world

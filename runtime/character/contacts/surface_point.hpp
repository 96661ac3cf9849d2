// surface_point.hpp  One vertex of the soft surface at one of the last two ticks: displaced, skinned, placed.
#pragma once
#include <Eigen/Core>

#include "character/asset/surface_patches.hpp"
#include "character/instance.hpp"

namespace sinew::world {

struct SurfacePoint {
  Eigen::Vector3f place_m;          // from the tick's root, world axes
  Eigen::Matrix3f world_from_bind;  // of a small displacement
};

// Under nodes' displacements along the axes of their flesh, [nodes][3]; `age` 0: this tick, 1: the one
// before.
SurfacePoint surface_point(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
                           const float* displacement, uint32_t age) noexcept;
// The same, pushed as it is now.
Eigen::Vector3f pushed_place(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
                             const float* displacement, uint32_t age) noexcept;
// How a vertex is pushed (character/contacts/push_surface.hpp): its first number, the others `pitch` further
// each.
float* push_of(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
               size_t* pitch) noexcept;

}  // namespace sinew::world

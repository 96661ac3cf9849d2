// read_points.hpp  Single points of the surface that is shown.
#pragma once
#include <span>

#include "character/instance.hpp"

namespace sinew::world {

// As World::read_points refuses; nothing is written.
Status check_points(const PointsDef& def, std::span<const SurfacePlace> places, const Asset& asset) noexcept;
void read_points(const Instance& instance, const PointsDef& def, std::span<const SurfacePlace> places,
                 Matrix34* out) noexcept;

}  // namespace sinew::world

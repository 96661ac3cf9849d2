// read.hpp  The published surface written into the caller's memory.
#pragma once
#include "character/instance.hpp"
#include "sinew/types.hpp"

namespace sinew::world {

// kInvalidArgument: space, streams or capacity; kNotFinite: origin. Nothing is written on refusal.
Status check_read(const SurfaceReadDef& def, const Asset& asset) noexcept;
Status check_origin(const double (&origin_m)[3]) noexcept;

// The definition has been checked. Positions alone: any number of threads at a time; normals and tangents use
// the instance's scratch: one thread at a time an instance. Writes each number once and reads none.
void read_surface(const Instance& instance, const SurfaceReadDef& def) noexcept;

}  // namespace sinew::world

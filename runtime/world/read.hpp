// read.hpp  The published surface written into the caller's memory.
#pragma once
#include "sinew/types.hpp"
#include "world/instance.hpp"

namespace sinew::world {

// kInvalidArgument: space, out, stride or capacity; kNotFinite: origin. Nothing is written on refusal.
Status check_read(const ReadDef& def, uint32_t vertex_count, bool normals) noexcept;

// The definition has been checked. Any number of threads at a time.
void read_positions(const Instance& instance, const ReadDef& def) noexcept;
// Uses the instance's scratch: one thread at a time an instance. Writes each normal once and reads none.
void read_normals(const Instance& instance, const ReadDef& def) noexcept;

}  // namespace sinew::world

// debug_lines.hpp  What is simulated, as coloured lines for an engine to draw.
#pragma once
#include <span>

#include "character/instance.hpp"

namespace sinew::world {

// As World::debug_lines.
size_t draw_lines(const Instance& instance, uint32_t parts, const double (&origin_m)[3],
                  std::span<DebugLine> out) noexcept;

}  // namespace sinew::world

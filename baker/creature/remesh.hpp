// remesh.hpp  Well-shaped triangles of chosen size on the body's surface.
#pragma once
#include <cstddef>

#include "baker/creature/body_field.hpp"
#include "baker/creature/surface.hpp"

namespace sinew::baker {

// Remeshes a closed surface (Botsch and Kobbelt 2004: split, collapse, flip, relax, project) until it has
// this many vertices within 2 %, edge lengths in proportion to the field's edge_scale. The topology stays.
Surface remesh(const BodyField& field, Surface surface, size_t vertices);

}  // namespace sinew::baker

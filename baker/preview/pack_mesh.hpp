// pack_mesh.hpp  A baked character's surface, ready to be drawn.
#pragma once
#include "baker/render/mesh.hpp"
#include "pack/reader.hpp"

namespace sinew::baker {

// The bind pose, in the colours that were baked.
render::Mesh bind_mesh(const pack::PackView& character);

}  // namespace sinew::baker

// side.hpp  From which side a character is filmed.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "baker/render/mesh.hpp"

namespace sinew::demo {

inline constexpr float kPitch_deg = 11;

// Turn of the camera about +Y for "front", "side" and "back" of a character that looks along facing_deg; for
// "auto" the three quarters from which most of what moves is seen, best from the front. weights: of the bind
// mesh's vertices, how far each goes.
float camera_yaw_deg(const std::string& view, float facing_deg, const render::Mesh& bind,
                     std::span<const float> weights);

}  // namespace sinew::demo

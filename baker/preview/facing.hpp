// facing.hpp  Which way a character looks.
#pragma once
#include <string_view>

#include "pack/reader.hpp"

namespace sinew::baker {

enum class Side { kNone, kLeft, kRight };

// By the words and letters that rigs mark a pair's joints with: "LeftArm", "thigh_l", "Ear1.R",
// "J_Bip_L_Hand".
Side side_of(std::string_view joint_name);

// Turn about +Y from +Z. Where joints on the left lie to the left of those on the right, the character looks
// at the viewer; without such names it looks along +Z, as glTF states. VRM 0 looks along -Z.
float facing_yaw_deg(const pack::PackView& character);

}  // namespace sinew::baker

// column.hpp  A round column of skin on a chain of bones, two metres high: enough of a character to be laid
// out.
#pragma once
#include "baker/import/character/character.hpp"

// Rings of 24 vertices every 5 cm from y = 0 to 2, radius 0.2 m, closed by a vertex at each end; the seam at
// ring vertex 0 is doubled, as texture seams are. Four joints "bone_0".."bone_3" at y = 0, 0.5, 1, 1.5; skin
// weights run linearly from one to the next around each joint.
sinew::baker::Character column();

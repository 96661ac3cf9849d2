// bones.hpp  The skeleton in the bind pose: segments, chains, and how much flesh lies over them.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

struct Bones {
  std::vector<Vector3> head, tail;  // of each joint: from its place to that of the child that goes on with it
  std::vector<int> main_child;      // that child, -1 for none
  std::vector<bool> helper;         // lies in the flesh of its parent, whose bone it shares
};

// helpers: joints that are no bones of their own; empty for none.
Bones find_bones(const Character& character, const std::vector<bool>& helpers);

// Metres from each vertex to the nearest bone that moves it (a share of at least a fifth).
std::vector<double> flesh_thickness(const Character& character, const Bones& bones);

// Joints that move as one limb segment have one number: a chain of bones, cut where it grows longer than
// max_length_m. Helpers have -1.
std::vector<int> limb_segments(const Character& character, const Bones& bones, double max_length_m);

double bind_height(const Character& character);

}  // namespace sinew::baker

// anatomy.hpp  Where front, below and the spine of a character are, in its bind pose.
#pragma once
#include <optional>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

struct Anatomy {
  Vector3 forward = Vector3::UnitZ();  // unit, level: where feet point, and the head of what lies
  Vector3 aside = Vector3::UnitX();    // unit, from right to left or the other way round
  double middle_m = 0;                 // along `aside`, of the plane between left and right
  Vector3 axis = Vector3::UnitY();     // unit, along the spine to the neck
  bool lies = false;                   // the spine is nearer to level than to upright: a quadruped
  std::vector<int> spine;              // joints that move flesh, from the pelvis to below the neck
  std::vector<Vector3> line;           // their places, and where the last one's bone ends
  std::vector<int> belly;   // of the spine, those between hind and fore limbs; all where none is between
  std::vector<int> thighs;  // upper bones of the limbs that hang on the spine's first joint with limbs
  std::vector<bool> trunk;  // a joint: of the spine, or what riggers add to it that is no limb
};

// By names of heads and by limbs in pairs, wherever the character stands and faces along x or z. Nothing
// where there is no such pair, as of a worm or a pillar.
std::optional<Anatomy> find_anatomy(const Character& character);

// The point of the polyline that is nearest to a place.
Vector3 nearest_on(const std::vector<Vector3>& line, const Vector3& place);

}  // namespace sinew::baker

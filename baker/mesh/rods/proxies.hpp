// proxies.hpp  Capsules about bones, for rods and soft parts to collide with where a mesh would cost too
// much.
#pragma once
#include <cstdint>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/recipe/recipe.hpp"

namespace sinew::baker {

struct Proxy {
  int joint = 0;
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  // bind pose
  double radius_m = 0;
  std::vector<int> groups = {};  // of a file's collider: BodyCollider::groups
};

// Bits of the proxies, in their order, that a spring of these groups does not collide with: all of the file's
// colliders that are in none of them.
uint64_t proxies_outside(const std::vector<Proxy>& proxies, const std::vector<int>& groups);

// None for a character without rods and regions that touch the body. The colliders that the file states,
// where it has any; else a capsule for each bone that moves 20 vertices or more above all others, no rod's
// and none the recipe leaves out. The recipe's radii take the place of fitted ones. At most 64, the largest;
// in the order of joints. Throws BadInput for a recipe's joint that is not there, with the nearest name.
std::vector<Proxy> find_proxies(Character& character, const Bones& bones, const std::vector<bool>& on_rods,
                                const Recipe& recipe);

}  // namespace sinew::baker

// rods.hpp  Bones that swing as rods: which ones, their segments and what these are made of.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/recipe/evidence.hpp"
#include "baker/mesh/recipe/recipe.hpp"

namespace sinew::baker {

// A bone's segment, from its joint to where the next one begins, and the joint that holds its beginning; bind
// pose, metres.
struct RodBone {
  int joint = -1;   // -1: a stiff link from a bone's end to a child that begins elsewhere
  int parent = -1;  // in Rod::bones, before it; -1: the first, which hangs on Rod::attach
  Vector3 begin = Vector3::Zero(), end = Vector3::Zero();
  double radius_m = 0, density_kg_m3 = 0, young_modulus_pa = 0, torsion_modulus_pa = 0, damping_s = 0,
         drag_per_s = 0;
};

struct Rod {
  std::string name;
  int attach = 0;      // the joint that the first bone hangs on
  int end_joint = -1;  // that holds the last bone's end as well, of a chain; -1: it is free
  double gravity = 1, sag = 0, max_displacement = 0;
  Vector3 gravity_direction = -Vector3::UnitY();  // unit
  std::vector<int> collider_groups;               // of a spring: BodyCollider::groups
  uint64_t passed_proxies = 0;  // a bit each of TissueLayout::proxies, which it does not collide with
  bool states_limit = true;     // it is a recipe's; else it may be lowered, where there is none too
  bool learned_start = false;   // RodRecipe
  std::vector<RodBone> bones;
  Evidence evidence = Evidence::kRecipe;
  SoftKind kind = SoftKind::kOther;
  double frequency_hz = 0;  // about that of its slowest swing
};

// The recipe's rods, else the file's springs (what is made of their numbers: rods.cpp; what does not become a
// rod is left out with a note). In the order of their roots' joints. A bone's segment ends where its child
// with most bones below it begins, else at its end site: a node without skin below it. What has neither is as
// long as its parent's and goes straight on.
//
// Throws BadInput with the rod and the bone, for the recipe's: a bone that is not there (with the nearest
// name), an end that is not below the root, a root without a parent, a single bone without an end, two joints
// in one place, a bone in two rods, a rod that hangs on another one, an end held by a bone that a rod moves
// or of a rod with branches.
//
// claimed: joints that stronger evidence than a spring has; a spring that moves one is skipped.
std::vector<Rod> find_rods(Character& character, const Recipe& recipe, const std::vector<bool>& claimed = {},
                           std::vector<SkippedPart>* skipped = nullptr);

// As the recipe's, of names: one that cannot be made is skipped.
void add_named_rods(const Character& character, const std::vector<RodRecipe>& named, std::vector<Rod>& rods,
                    std::vector<SkippedPart>& skipped);

// Of bones whose parents come before them, by Dunkerley: the squares of periods add up along a chain, and the
// whole swings no slower.
double slowest_swing_rad_per_s(const std::vector<RodBone>& bones);

// For each joint, whether a rod moves it: its bones and all that hangs on them.
std::vector<bool> joints_on_rods(const Character& character, const std::vector<Rod>& rods);

}  // namespace sinew::baker

// scenes.hpp  What happens to the creature.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "baker/render/camera.hpp"
#include "samples/contacts/boxes.hpp"
#include "samples/demo/character_file.hpp"
#include "sinew/types.hpp"

namespace sinew::sample {

struct ContactScene {
  std::string name, title;
  std::vector<Box> boxes;
  std::function<RootTransform(double t_s)> root;
  // Of joints, from the bind pose; null: they stay.
  std::function<void(const demo::CharacterFile&, double t_s, std::span<Matrix34> joints)> pose = {};
  std::vector<std::string> limbs =
      {};  // beginnings of names: whose capsules its flesh touches and is measured by
  double seconds = 0;
  std::vector<double> moments_s;  // in pictures, ascending
  double rest_from_s = 0;         // nothing moves any more: what still trembles is counted
  render::View view;
  Eigen::AlignedBox3f shown = {};          // of the world; empty: all
  bool sees_into = false;                  // boxes are drawn as their edges
  std::vector<std::string> left_out = {};  // beginnings of bones' names: not drawn in the last moment
};

// It leaps forward and lands on its belly, on a crate.
ContactScene onto_a_crate();
// Two walls close in on belly and tail, wait and open again.
ContactScene between_walls();
// It hugs its belly. Flesh touches its own arms where the character's recipe says touches_body.
ContactScene arms_on_the_belly();

}  // namespace sinew::sample

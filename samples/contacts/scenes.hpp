// scenes.hpp  What happens to the creature.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "samples/contacts/boxes.hpp"
#include "samples/render/camera.hpp"
#include "sinew/types.hpp"

namespace sinew::sample {

struct ContactScene {
  std::string name, title;
  std::vector<Box> boxes;
  std::function<RootTransform(double t_s)> root;
  double seconds = 0;
  std::vector<double> moments_s;  // in pictures
  double rest_from_s = 0;         // nothing moves any more: what still trembles is counted
  render::View view;
};

// It leaps forward and lands on its belly, on a crate.
ContactScene onto_a_crate();
// Two walls close in on belly and tail, wait and open again.
ContactScene between_walls();

}  // namespace sinew::sample

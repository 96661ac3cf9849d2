// gesture.hpp  Smooth steps of the root and the joints: dashes, turns, tilts, and leaps made of them.
#pragma once
#include <vector>

#include "baker/truth/motion/random.hpp"

namespace sinew::baker {

// A smooth step: `change` between `start_s` and `start_s + length_s`, taken back after `back_s` where that is
// positive.
struct Gesture {
  double start_s, length_s, back_s;
  Vector3 change;
};

// By start_s; leaps of neighbouring stretches of time may overlap.
void put_in_order(std::vector<Gesture>* gestures);

// At t_s; gestures in order.
Vector3 sum_of(const std::vector<Gesture>& gestures, double t_s);

struct RootGestures {
  std::vector<Gesture> dashes;  // metres
  std::vector<Gesture> turns;   // about Y, radians
  std::vector<Gesture> tilts;   // rotation vectors
};
using JointGestures = std::vector<std::vector<Gesture>>;  // a joint: rotation vectors, in its own axes

// Dashes, turns and tilts between two times.
void draw_gestures(Random& random, double start_s, double end_s, double strength, RootGestures* root);

// Leaps between two times: crouch, throw, fall and catch, upwards or to any side, while the joints strike a
// pose in each phase. The harder of push-off and landing has 8 to 70 m/s^2 at strength 1. The last leap may
// end after end_s. joint_parent: -1 at a root.
void draw_leaps(Random& random, double start_s, double end_s, double strength,
                const std::vector<int>& joint_parent, RootGestures* root, JointGestures* joints);

}  // namespace sinew::baker

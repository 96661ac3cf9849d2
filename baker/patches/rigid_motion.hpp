// rigid_motion.hpp  A random motion of what holds a body: bouts of swings and turns, and rests between them.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "baker/truth/motion/random.hpp"

namespace sinew::baker {

struct RigidPose {
  Vector3 place = Vector3::Zero();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  // world from body
};

struct Liveliness {
  double acceleration;         // cells a tick^2, about the most
  double reach;                // cells: a turn moves this far a place as a swing does
  double least_rad, most_rad;  // a tick, of swings
};

// Poses `steps_a_tick` times a tick, from the start on, which is at rest in the body's own pose.
std::vector<RigidPose> random_rigid_motion(const Liveliness& how, uint32_t ticks, uint32_t steps_a_tick,
                                           Random& random);

}  // namespace sinew::baker

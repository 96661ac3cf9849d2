// story.hpp  What a scene leaves behind: who was in it, how they stood at some moments, and what it cost.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "baker/render/camera.hpp"
#include "baker/render/mesh.hpp"
#include "baker/render/picture/color.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::sample {

using Segments = std::vector<rods::SegmentDef>;
using Poses = std::vector<rods::SegmentPose>;  // one a segment

struct Look {
  render::Rgb color, stripe;       // the stripe runs along the rod, so that twist shows
  uint32_t sides = 16, rings = 4;  // of the tube: round it, and along each segment
};

struct Actor {
  Segments segments;
  Look look;
  std::vector<uint32_t> leafy;  // segments that carry leaves
};

struct Moment {
  double time_s = 0;
  std::string caption;
  std::vector<Poses> poses;  // one an actor
  Eigen::Isometry3f prop = Eigen::Isometry3f::Identity();
};

// Of all steps.
struct Measured {
  uint32_t steps = 0, segments = 0, strands = 0;
  double dt_s = 0;
  double length_ratio = 1;  // all joints' distances over their lengths at rest, where it was furthest from 1
  double largest_gap = 0;   // at a joint, of its segment's length
  double iterations_sum = 0;  // of all strands and steps
  uint32_t iterations_most = 0, unconverged = 0, recovered = 0, contacts_most = 0;
  double deepest_penetration = 0;  // of a segment's radius, along contacts' normals
  double deepest_by_shape = 0;     // the same as the shapes say it; where a scene measures it
  std::vector<double> step_us;     // thread CPU time
};

struct Story {
  std::string name, title;
  std::vector<Actor> actors;
  render::Mesh prop = {};  // what rods touch, in its own axes
  std::vector<Moment> moments = {};
  Measured measured = {};
  render::View view;
  int columns = 4;
  float grid_m = 0.5f;
};

}  // namespace sinew::sample

// run_scene.hpp  Steps a batch through its scene, measures every step, keeps some moments.
#pragma once
#include <functional>

#include "samples/rods/story.hpp"

namespace sinew::sample {

struct Scene {
  rods::RodBatch* batch;                  // one strand an actor
  rods::RodCollider* collider = nullptr;  // null: nothing collides
  double dt_s = 0, seconds = 0;
  std::vector<double> moments_s;  // rising
  // Before each step, with the time at its end: what drives the scene.
  std::function<void(double time_s)> drive = [](double) {};
  // Where the prop is, at a time.
  std::function<Eigen::Isometry3f(double time_s)> prop = {};
  // How deep rods are in what they touch, of a radius, after a step.
  std::function<double()> depth = {};
  // Of a moment; without: the time alone.
  std::function<std::string(double time_s)> caption = {};
};

// Throws std::runtime_error with the status' line unless it is ok.
void accept(const Status& status);

// Fills moments and measured of a story whose actors are there. Throws std::runtime_error where a step is
// refused.
void run_scene(const Scene& scene, Story* story);

// One a scene's line of the report.
std::string report_line(const Story& story);

}  // namespace sinew::sample

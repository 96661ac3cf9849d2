// scenes.hpp  What is done to a character, each frame, at the extremes of what may be.
#pragma once
#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "tests/extremes/act.hpp"

namespace sinew::extremes {

using Frame = std::function<void(Act&)>;  // changes what the coming frame sets, or calls the world itself

struct Scene {
  const char* name;
  Frame (*begin)(Act&);      // draws how strong it is
  bool deforms = false;      // joints are scaled, sheared or drawn apart, beyond what World::bounds counts on
  bool calls_world = false;  // parameters and tiers glide back to what they were, after it has ended
};
std::span<const Scene> all_scenes();

// A case: an instance that lives for a scene, of how it began.
struct Outcome {
  Reading worst;
  uint32_t frames = 0;
};
Outcome play(Subject& subject, const Scene& scene, uint64_t seed, uint32_t frames);

// The same beside a twin to whom nothing is done; then both play on for as long as the slowest part of the
// character needs to swing down to a tenth, and ten ticks more, forty where the scene calls the world; with
// their ticks at the same times.
struct Recovery {
  float largest = 0;  // difference of any vertex or rod's joint that came of it, share of the height
  float left = 0;     // at the end
  float wait_s = 0;
  bool is_back() const { return left <= std::max(0.1f * largest, 1e-3f); }
};
Recovery recover(Subject& subject, const Scene& scene, uint64_t seed, uint32_t frames);

}  // namespace sinew::extremes

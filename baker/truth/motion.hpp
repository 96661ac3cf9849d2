// motion.hpp  What moves a character while the truth is simulated: a clip, and a root motion on top.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "baker/import/character.hpp"

namespace sinew::baker {

struct WorldPose {
  std::vector<Matrix4> joints;                    // character-from-joint
  Matrix4 root = Matrix4::Identity();             // world-from-character, rigid
};

// Pose at any time >= 0; smooth in time, so that truth may sample it between ticks. The first half second is at rest.
using Motion = std::function<WorldPose(double t_s)>;

// The clip, looped, root at the origin.
Motion clip_motion(const Character& character, const Clip& clip);
// The built-in shake for characters without clips: the root moves and turns, the joints rest.
Motion shake_motion(const Character& character);
// Clips cross-faded at random, random band-limited joint noise, root translation and turns with stretches of stillness.
Motion random_motion(const Character& character, uint64_t seed, double strength);

}  // namespace sinew::baker

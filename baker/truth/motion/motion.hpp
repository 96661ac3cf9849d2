// motion.hpp  What moves a character while the truth is simulated: a clip, and a root motion on top.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

struct WorldPose {
  std::vector<Matrix4> joints;         // character-from-joint
  Matrix4 root = Matrix4::Identity();  // world-from-character, rigid
};

// Pose at any time >= 0; its second derivative is continuous, so that truth may sample it between ticks. At
// time 0 every motion is at rest, the root at the origin, in the pose in which a clip begins or in the rest
// pose. The same arguments give the same motion. strength: of the accelerations.
using Motion = std::function<WorldPose(double t_s)>;

// The clip, looped or to and fro (smooth_clip.hpp), the root at the origin; it comes up to speed within half
// a second. seed 0: the clip as it is; others: another speed (0.75 to 1.3) and start. strength: of its
// accelerations, by its speed.
Motion clip_motion(const Character& character, const Clip& clip, uint64_t seed = 0, double strength = 1);

// The built-in shake for characters without clips: the root moves and turns, the joints rest; still for the
// first tenth of a second and for the last of every four. seed: other frequencies and directions.
Motion shake_motion(const Character& character, uint64_t seed = 0, double strength = 1);

// Bouts of clips drawn at random, with band-limited joint noise, root dashes, sways and turns on top, and
// stretches of stillness in between, where a clip rests in its last pose; a bout leads from there into its
// own clip. Still for the first tenth of a second and after ten minutes. held_out: names of clips it must not
// use.
Motion random_motion(const Character& character, uint64_t seed, double strength,
                     const std::vector<std::string>& held_out = {});

// Clips and joint noise as in random_motion; the root leaps with up to 70 m/s^2 and the joints strike poses
// on the way, with stretches of stillness, which the end of a leap may shorten.
Motion leap_motion(const Character& character, uint64_t seed, double strength,
                   const std::vector<std::string>& held_out = {});

}  // namespace sinew::baker

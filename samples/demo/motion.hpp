// motion.hpp  What moves the demo's characters: baked clips, a shake for characters without clips, or a
// recorded trajectory.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "samples/demo/character_file.hpp"
#include "sinew/types.hpp"

namespace sinew::demo {

class Motion {
 public:
  virtual ~Motion() = default;
  // The pose at t_s >= 0. joints has one place for each joint of the character.
  virtual void pose_at(double t_s, std::span<Matrix34> joints, RootTransform* root) const = 0;
  // What plays then, for captions.
  virtual std::string name_at(double t_s) const = 0;
};

// One clip, looped; or, with an empty name, all of them in turn, cross-faded. Starts from rest. Throws
// baker::BadInput naming the clips there are. A character without clips is shaken by its root.
std::unique_ptr<Motion> make_motion(const CharacterFile& character, const std::string& clip);

}  // namespace sinew::demo

// pose_tape.hpp  A character's motion, sampled once: playing it costs next to nothing beside what is timed.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "samples/demo/character_file.hpp"
#include "samples/demo/motion.hpp"

namespace sinew::perf {

class PoseTape {
 public:
  // Of one clip, looped; with an empty name of all in turn, cross-faded. Begins anew after `seconds`. Throws
  // baker::BadInput.
  PoseTape(const demo::CharacterFile& character, double seconds, const std::string& clip = {});
  std::span<const Matrix34> joints(double time_s) const;  // the nearest frame of 60 a second; loops

 private:
  size_t joint_count_, frames_;
  std::vector<Matrix34> joints_;
};

}  // namespace sinew::perf

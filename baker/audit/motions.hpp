// motions.hpp  What an audit plays: the pack's clips, and motions of the root alone that every character
// meets.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pack/reader.hpp"
#include "sinew/types.hpp"

namespace sinew::baker {

struct AuditMotion {
  std::string name;
  double moving_s = 0;   // how long the pose moves
  double resting_s = 0;  // and is then held
  std::function<void(double t_s, std::span<Matrix34> joints, RootTransform* root)> pose_at;
  bool is_everyday = false;  // a clip or the bob: what moves in none of these is seldom seen to move
};

// The root goes up and down by 5 % of the height at 2 Hz, in the bind pose.
AuditMotion bob_motion(const pack::PackView& character, double moving_s, double resting_s);
// One jump by 0.4 heights; a run that stops; a turn about the upright axis. Times go with the square root of
// the height, as gravity has it.
std::vector<AuditMotion> root_motions(const pack::PackView& character);
AuditMotion clip_motion(const pack::PackView& character, size_t clip);
// All that a whole audit plays.
std::vector<AuditMotion> audit_motions(const pack::PackView& character);
// That in which joints travel fastest in the mean; clips.size() > 0.
size_t liveliest_clip(const pack::PackView& character);

}  // namespace sinew::baker

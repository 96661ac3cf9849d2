// tier_change.hpp  What is seen of a change from one tier to another.
#pragma once
#include <vector>

#include "perf/frames/jump_player.hpp"

namespace sinew::perf {

inline constexpr size_t kWatched = 64;  // ticks: the longest blend and a little

using Steps = std::vector<float>;  // [vertices]: metres from one frame to the next

// A tier all along.
struct Run {
  std::vector<Surface> surfaces;        // [ticks]
  std::vector<Steps> steps;             // [ticks]: of this frame and the two before it the longest
  std::vector<JumpPlayer::Mark> marks;  // after every so many ticks
};

Run run_in(JumpPlayer& player, const Way& way, size_t apart_ticks);

// What an instance has before a change, and would show without it.
struct Stay {
  JumpPlayer::Mark mark;
  Surface shown;                 // last
  std::vector<Surface> without;  // [kWatched] frames from the change on, or as many as there are
  std::vector<Steps> steps;      // of these, as a run's
  std::vector<Steps> had;        // where what it misses is made up for: of the tier before, all along
};

// All moments of change of one that has this tier all along.
std::vector<Stay> stays_in(const Run& run);
// Of one that had it, then was left alone so for so many ticks; who was hidden has been back for a frame, in
// which a world shows it skinned.
std::vector<Stay> stays_after(JumpPlayer& player, const Run& run, const Way& left, size_t ticks);

// The vertex where it is largest, of all changes.
//   at once      how far the surface is, in the first frame, from where it would be without the change
//   beyond both  how much further a vertex moves, from one frame to the next in the kWatched after the
//   change,
//                than it did in that frame and the two before it in either tier all along: what no tier's own
//                motion explains
//   change_tick, after_ticks  when the latter's change was, and how long after it that frame
//   beyond all   the same, beyond the tier too that it left a tick or two before, which is made up for
struct Jump {
  double at_once_m = 0, beyond_m = 0, beyond_all_m = 0;
  size_t change_tick = 0, after_ticks = 0;
};

Jump largest_jump(JumpPlayer& player, const std::vector<Stay>& from, const Run& to, const Way& way);

}  // namespace sinew::perf

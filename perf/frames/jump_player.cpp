// jump_player.cpp  see jump_player.hpp.
#include "perf/frames/jump_player.hpp"

#include <algorithm>

namespace sinew::perf {
namespace {

constexpr double kBehind_s = 0.1;  // that the last tick does not meet the tape's beginning

}  // namespace

JumpPlayer::JumpPlayer(const demo::CharacterFile& character, const std::string& clip, double seconds)
    : seconds_(seconds), tape_(character, seconds + kBehind_s, clip), lone_(character.file.bytes()) {}

void JumpPlayer::step(const Way& way) {
  std::ranges::copy(tape_.joints(static_cast<double>(++tick_) * lone_.tick_s()), lone_.joints().begin());
  if (way.hidden)
    lone_.step_hidden();
  else
    lone_.step({.tier = way.tier, .level = way.level});
}

Surface JumpPlayer::surface() const { return lone_.positions(Space::kBind); }

JumpPlayer::Mark JumpPlayer::mark() const { return {lone_.save(), tick_}; }

void JumpPlayer::go_back(const Mark& mark) {
  lone_.restore(mark.state);
  tick_ = mark.tick;
}

size_t JumpPlayer::ticks() const { return static_cast<size_t>(seconds_ / lone_.tick_s()); }

}  // namespace sinew::perf

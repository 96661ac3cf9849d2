// jump_player.hpp  One instance along one of its character's clips, a tick a frame, in whatever tier it is
// told.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "baker/common/lone_instance.hpp"
#include "perf/frames/pose_tape.hpp"

namespace sinew::perf {

struct Way {
  Tier tier = Tier::kSkinning;
  uint32_t level = 0;
  bool hidden = false;  // passed by; shows what it did
};

using Surface = std::vector<float>;  // [vertices][3], metres, before skinning

class JumpPlayer {
 public:
  struct Mark {
    std::vector<std::byte> state;
    size_t tick = 0;
  };

  // Of the clip, looped.
  JumpPlayer(const demo::CharacterFile& character, const std::string& clip, double seconds);
  void step(const Way& way);
  Surface surface() const;
  Mark mark() const;
  void go_back(const Mark& mark);
  size_t ticks() const;  // of the clips
  double height_m() const { return lone_.height_m(); }
  const world::Asset& asset() const { return lone_.asset(); }

 private:
  double seconds_;
  PoseTape tape_;
  baker::LoneInstance lone_;
  size_t tick_ = 0;
};

}  // namespace sinew::perf

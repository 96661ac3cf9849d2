// encode.hpp  A PNG sequence to a film, by the ffmpeg that is installed.
#pragma once
#include <string>

namespace sinew::render {

struct Film {
  std::string pattern;  // of the frames, as printf has it: "out/frame_%04d.png", from 0
  double fps = 30;
  std::string path;   // its ending says what is made: .mp4 (H.264) or .gif
  int max_width = 0;  // wider frames are scaled down; 0: as they are
};

// Empty on success, else one line that says why there is no film. The frames stay in both cases.
std::string encode(const Film& film);

}  // namespace sinew::render

// options.hpp  What the demo was asked to do.
#pragma once
#include <limits>
#include <string>

namespace sinew::demo {

struct Options {
  std::string pack;
  std::string compare;  // another pack of the same character, played beside it
  int instances = 1;
  double seconds = 0;  // 0: the truth's length, else four
  double fps = 0;      // 0: the truth's rate, else 60
  double budget_us = std::numeric_limits<double>::infinity();
  int threads = 1;
  bool camera = false;        // turning_camera.hpp; without: all are in view
  std::string clip;           // empty: one clip after the other
  std::string truth;          // a trajectory with positions, see `sinew-bake truth --positions`
  std::string report;         // JSON
  std::string trace;          // JSON of Chrome's trace viewer and of Perfetto
  std::string frames;         // folder of pictures
  std::string view = "auto";  // side.hpp
  std::string start;          // of rods: baked, continued, learned; empty: baked, and no residual is told
  bool contacts = true;       // with its own body, where it was baked with colliders
  int width = 220, height = 260, samples = 4;  // of each panel
  double picture_fps = 0;                      // of the film; 0: none
};

// False: help was printed, there is nothing to do. Throws baker::BadInput with one line.
bool parse_options(int argc, char** argv, Options* out);

}  // namespace sinew::demo

// sheet.hpp  A story's moments as one picture.
#pragma once
#include "baker/render/picture/image.hpp"
#include "samples/rods/story.hpp"

namespace sinew::sample {

struct PictureSize {
  int width = 400, height = 440, samples = 32, threads = 0;
};

// One camera for all moments, captions with times under them.
render::Image sheet(const Story& story, const PictureSize& size);

}  // namespace sinew::sample

// part_picture.hpp  What of a character moves by itself, seen from the front and the side.
#pragma once
#include <string>
#include <vector>

#include "baker/preview/parts.hpp"
#include "baker/render/picture/image.hpp"

namespace sinew::baker {

struct PartPicture {
  int width = 840, height = 560;  // of both views, pixels; the legend beside them takes what its words need
  int samples = 8;                // rays a pixel
  std::vector<std::string> captions = {};  // of each part, before its name
};

// In the bind pose, the character facing the viewer: soft parts in colours over its own, rods as lines along
// their bones, which the body does not hide, and the names of all.
render::Image part_picture(const pack::PackView& character, const PartPicture& picture = {});

}  // namespace sinew::baker

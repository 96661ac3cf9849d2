// picture.hpp  The bust and its hair as a lit mesh.
#pragma once
#include "baker/render/picture/image.hpp"
#include "samples/hair/hair.hpp"
#include "samples/hair/tiers.hpp"

namespace sinew::sample {

struct HairPicture {
  int width = 360, height = 480, samples = 32, threads = 0;
  float yaw_deg = 25;
};

render::Image picture(const Hair& hair, const HairPicture& size);
render::Image picture(const TieredHair& hair, const HairPicture& size);

}  // namespace sinew::sample

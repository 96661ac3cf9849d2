// picture.hpp  A played scene as one picture: above without contacts, below with them.
#pragma once
#include "baker/render/picture/image.hpp"
#include "samples/contacts/play.hpp"

namespace sinew::sample {

struct ContactPicture {
  int width = 330, height = 380, samples = 32, threads = 0;
};

render::Image picture(const demo::CharacterFile& character, const ContactScene& scene,
                      const ContactPlay& play, const ContactPicture& size);

}  // namespace sinew::sample

// crowd_picture.hpp  All instances on the floor, tinted by what each got in the last frame.
#pragma once
#include "baker/render/picture/image.hpp"
#include "samples/demo/simulate.hpp"

namespace sinew::demo {

render::Image crowd_picture(const CharacterFile& character, const Run& run, const Options& options);

}  // namespace sinew::demo

// pictures.hpp  A recorded run as pictures: a PNG sequence, a film, a contact sheet, a large still, the
// crowd.
#pragma once
#include "samples/demo/simulate.hpp"

namespace sinew::demo {

// Into options.frames: frame_0000.png ..., animation.mp4 and animation.gif (with ffmpeg), contact_sheet.png,
// still.png, and crowd.png when there are several instances. Prints where they are.
void make_pictures(const Run& run, const CharacterFile& character, const Options& options);

}  // namespace sinew::demo

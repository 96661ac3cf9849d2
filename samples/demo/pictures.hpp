// pictures.hpp  A recorded run as pictures: a contact sheet, a large still, a film, the crowd.
#pragma once
#include "samples/demo/simulate.hpp"

namespace sinew::demo {

// Into options.frames: contact_sheet.png and still.png; with options.picture_fps frame_0000.png ...,
// animation.mp4 and animation.gif (with ffmpeg); crowd.png when there are several instances. Prints where
// they are. other: film_set.hpp.
void make_pictures(const Run& run, const Run* other, const CharacterFile& character, const Options& options);

}  // namespace sinew::demo

// write_preview.hpp  A baked character's parts as a PNG file.
#pragma once
#include <string>
#include <vector>

#include "pack/reader.hpp"

namespace sinew::baker {

// part_picture.hpp. captions: of each part, before its name. Throws BadInput when the path cannot be written,
// or when this build has no renderer.
void write_preview(const std::string& path, const pack::PackView& character,
                   const std::vector<std::string>& captions = {});

}  // namespace sinew::baker

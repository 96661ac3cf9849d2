// required_extensions.hpp  Extensions without which a file must not be read.
#pragma once
#include <tiny_gltf.h>

#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

// Throws BadInput for a required extension that is not known or not followed (glTF 2.0, 3.12), by its name.
void check_required_extensions(const tinygltf::Model& model, const Source& source);

}  // namespace sinew::baker

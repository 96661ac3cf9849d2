// gltf_file.hpp  Bytes of a .gltf, .glb or .vrm to tinygltf's model, with everything tinygltf trusts checked
// before.
#pragma once
#include <tiny_gltf.h>

#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

// Throws BadInput: unreadable, not glTF, damaged container, missing buffer, compression that is not
// supported.
tinygltf::Model read_gltf_file(Source& source);

}  // namespace sinew::baker

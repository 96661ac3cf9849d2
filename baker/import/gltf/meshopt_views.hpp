// meshopt_views.hpp  Buffer views that EXT_meshopt_compression holds compressed, as gltfpack writes them.
#pragma once
#include <tiny_gltf.h>

#include <vector>

#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

// Buffers that only say how long uncompressed bytes would be have neither bytes nor a uri, which tinygltf
// refuses: they get a byte. `bytes`: the whole file, .gltf or .glb, checked (gltf_file.cpp).
void give_fallback_buffers_bytes(std::vector<unsigned char>& bytes);

// Decodes every compressed view into a buffer of its own. Throws BadInput: fields missing or out of range,
// bytes that do not decode, more than 1 GiB.
void decode_meshopt_views(tinygltf::Model& model, const Source& source);

}  // namespace sinew::baker

// import_gltf.hpp  A skinned glTF 2.0 or VRM file made into a Character.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

struct ImportOptions {
  double unit_m = 0;  // metres in one file unit; 0: 1, but a character taller than 50 units is in centimetres
  char up = 'y';      // the file's up axis: 'y' (glTF's own) or 'z'
  std::vector<std::string> without_meshes = {};  // names or prefix* of meshes, or of nodes that show them
  std::vector<std::string> with_meshes = {};     // of what a viewer does not show: shown_meshes.hpp
  size_t max_vertices = 1'000'000;  // a larger character is refused before its buffers are copied
};

// Throws BadInput with one line (what, where, how to mend).
Character import_gltf(const std::string& path, const ImportOptions& options = {});

}  // namespace sinew::baker

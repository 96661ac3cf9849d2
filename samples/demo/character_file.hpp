// character_file.hpp  A baked character as the demo needs it beside the world: its names, mesh and clips.
#pragma once
#include <string>
#include <vector>

#include "pack/mapped_file.hpp"
#include "pack/reader.hpp"

namespace sinew::demo {

struct CharacterFile {
  std::string path;
  pack::MappedFile file;
  pack::PackView view;  // into file

  std::string name() const { return pack::string_at(view, view.character->name); }
  std::string clip_name(size_t clip) const { return pack::string_at(view, view.clips[clip].name); }
};

// Throws baker::BadInput: unreadable, damaged, or a model without a character.
CharacterFile open_character(const std::string& path);

// What keeps the two from being one character under the same motion, as baked twice; empty: nothing.
std::string difference(const CharacterFile& a, const CharacterFile& b);
// Ascending, each once: the vertices that tissue moves.
std::vector<uint32_t> soft_vertices(const CharacterFile& character);

}  // namespace sinew::demo

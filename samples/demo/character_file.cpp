// character_file.cpp  see character_file.hpp.
#include "samples/demo/character_file.hpp"

#include <algorithm>

#include "baker/common/bad_input.hpp"

namespace sinew::demo {

CharacterFile open_character(const std::string& path) {
  CharacterFile out;
  out.path = path;
  Status status = pack::MappedFile::open(path.c_str(), &out.file);
  if (!status.ok()) throw baker::BadInput(status.message);
  status = pack::open_pack(out.file.bytes(), &out.view);
  if (!status.ok()) throw baker::BadInput(path + ": " + status.message);
  if (out.view.character == nullptr) {
    throw baker::BadInput(
        path +
        ": is a model without a character; bake one with: sinew-bake character IN.glb --tissue W -o C.sinew");
  }
  return out;
}

std::string difference(const CharacterFile& a, const CharacterFile& b) {
  const auto other_than = [](size_t have, size_t want, const char* what) {
    return std::to_string(have) + " " + what + " instead of " + std::to_string(want);
  };
  const pack::PackView &x = a.view, &y = b.view;
  if (x.joints.size() != y.joints.size()) return other_than(y.joints.size(), x.joints.size(), "joints");
  for (size_t j = 0; j < x.joints.size(); ++j) {
    const std::string want = pack::string_at(x, x.joints[j].name),
                      have = pack::string_at(y, y.joints[j].name);
    if (want != have) return "joint '" + have + "' instead of '" + want + "'";
  }
  if (x.character->vertex_count != y.character->vertex_count)
    return other_than(y.character->vertex_count, x.character->vertex_count, "vertices");
  if (!std::ranges::equal(x.triangles, y.triangles)) return "other triangles";
  return "";
}

std::vector<uint32_t> soft_vertices(const CharacterFile& character) {
  std::vector<uint32_t> out(character.view.region_vertices.begin(), character.view.region_vertices.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace sinew::demo

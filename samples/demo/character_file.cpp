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

render::Mesh bind_mesh(const CharacterFile& character) {
  const pack::PackView& view = character.view;
  const size_t vertices = view.character->vertex_count;
  render::Mesh mesh;
  for (size_t v = 0; v < vertices; ++v) {
    mesh.positions.emplace_back(view.positions[3 * v], view.positions[3 * v + 1], view.positions[3 * v + 2]);
    mesh.normals.emplace_back(view.normals[3 * v], view.normals[3 * v + 1], view.normals[3 * v + 2]);
    const bool painted = !view.colors.empty();
    mesh.colors.push_back(painted ? render::linear_from_srgb(
                                        {view.colors[4 * v], view.colors[4 * v + 1], view.colors[4 * v + 2]})
                                  : render::Rgb::Constant(0.6f));
  }
  for (size_t t = 0; t + 2 < view.triangles.size(); t += 3) {
    mesh.triangles.push_back({view.triangles[t], view.triangles[t + 1], view.triangles[t + 2]});
  }
  return mesh;
}

std::vector<uint32_t> soft_vertices(const CharacterFile& character) {
  std::vector<uint32_t> out(character.view.region_vertices.begin(), character.view.region_vertices.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace sinew::demo

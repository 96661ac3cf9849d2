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

namespace {

std::vector<uint32_t> each_once(std::vector<uint32_t> vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace

std::vector<uint32_t> soft_vertices(const CharacterFile& character) {
  return each_once({character.view.region_vertices.begin(), character.view.region_vertices.end()});
}

std::vector<uint32_t> moved_vertices(const CharacterFile& character) {
  const pack::PackView& view = character.view;
  std::vector<uint32_t> out(view.region_vertices.begin(), view.region_vertices.end());
  if (view.rods.empty()) return each_once(std::move(out));
  for (uint32_t v = 0; v < view.character->vertex_count; ++v)
    if (view.joint_rods[view.skin[v].joint[0]] != pack::kNoIndex) out.push_back(v);  // weights descend
  return each_once(std::move(out));
}

}  // namespace sinew::demo

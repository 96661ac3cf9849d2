// pack_mesh.cpp  see pack_mesh.hpp.
#include "baker/preview/pack_mesh.hpp"

namespace sinew::baker {

render::Mesh bind_mesh(const pack::PackView& view) {
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

}  // namespace sinew::baker

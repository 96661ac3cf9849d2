// character_mesh.cpp  see character_mesh.hpp.
#include "samples/portrait/character_mesh.hpp"

#include "baker/common/bad_input.hpp"

namespace sinew::portrait {
namespace {

std::vector<render::Rgb> file_colors(const baker::Character& character) {
  std::vector<render::Rgb> colors;
  colors.reserve(character.colors.size());
  for (const auto& c : character.colors) colors.push_back(render::linear_from_srgb({c[0], c[1], c[2]}));
  return colors;
}

// Soft parts stand out.
std::vector<render::Rgb> stiffness_colors(const baker::Character& character) {
  if (character.stiffness.empty()) {
    throw baker::BadInput(character.name + ": paints no _STIFFNESS on its vertices; leave --stiffness out");
  }
  std::vector<render::Rgb> colors;
  colors.reserve(character.stiffness.size());
  for (const double s : character.stiffness) colors.push_back(render::ramp(static_cast<float>(1 - s)));
  return colors;
}

}  // namespace

render::Mesh posed_mesh(const baker::Character& character, const baker::Clip* clip, double t_s, Paint paint) {
  render::Mesh mesh;
  for (const baker::Vector3& p :
       baker::skin_positions(character, baker::joint_matrices(character, clip, t_s))) {
    mesh.positions.push_back(p.cast<float>());
  }
  for (const auto& [a, b, c] : character.triangles) {
    mesh.triangles.push_back({static_cast<uint32_t>(a), static_cast<uint32_t>(b), static_cast<uint32_t>(c)});
  }
  const std::vector<uint32_t> welded(character.welded.begin(), character.welded.end());
  mesh.normals = render::smooth_normals(mesh.positions, mesh.triangles, welded);
  mesh.colors = paint == Paint::kColors ? file_colors(character) : stiffness_colors(character);
  return mesh;
}

const baker::Clip& find_clip(const baker::Character& character, const std::string& name) {
  std::string known;
  for (const baker::Clip& clip : character.clips) {
    if (clip.name == name) return clip;
    known += (known.empty() ? "" : ", ") + clip.name;
  }
  throw baker::BadInput(character.name + ": no clip '" + name + "'; it has " +
                        (known.empty() ? "none" : known));
}

}  // namespace sinew::portrait

// picture.cpp  see picture.hpp.
#include "samples/contacts/picture.hpp"

#include <algorithm>
#include <cstdio>

#include "baker/preview/pack_mesh.hpp"
#include "baker/render/picture/layout.hpp"
#include "baker/render/renderer.hpp"

namespace sinew::sample {
namespace {

void append(const render::Mesh& from, render::Mesh* to) {
  const auto first = static_cast<uint32_t>(to->positions.size());
  to->positions.insert(to->positions.end(), from.positions.begin(), from.positions.end());
  to->normals.insert(to->normals.end(), from.normals.begin(), from.normals.end());
  to->colors.insert(to->colors.end(), from.colors.begin(), from.colors.end());
  for (const auto& t : from.triangles) to->triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

// What is inside of something.
void color_depths(const std::vector<float>& depths_m, render::Mesh* mesh) {
  constexpr float kRounding_m = 1e-5f;
  const render::Rgb kInside = {0.9f, 0.02f, 0.1f};
  for (size_t v = 0; v < depths_m.size(); ++v)
    if (depths_m[v] > kRounding_m) mesh->colors[v] = kInside;
}

bool is_of(const demo::CharacterFile& character, uint32_t vertex, const std::vector<std::string>& limbs) {
  const pack::SkinRecord& skin = character.view.skin[vertex];
  const std::string_view bone = pack::string_at(character.view, character.view.joints[skin.joint[0]].name);
  return std::ranges::any_of(limbs, [&](const std::string& limb) { return bone.starts_with(limb); });
}

render::Mesh mesh_of(const demo::CharacterFile& character, const ContactMoment::Surface& surface,
                     const render::Mesh& boxes, const std::vector<std::string>& left_out) {
  render::Mesh mesh = baker::bind_mesh(character.view);
  mesh.positions = surface.places;
  mesh.normals = render::smooth_normals(surface.places, mesh.triangles, character.view.welded);
  color_depths(surface.depths_m, &mesh);
  std::erase_if(mesh.triangles, [&](const auto& t) { return is_of(character, t[0], left_out); });
  append(boxes, &mesh);
  return mesh;
}

}  // namespace

render::Image picture(const demo::CharacterFile& character, const ContactScene& scene,
                      const ContactPlay& play, const ContactPicture& size) {
  std::vector<render::Mesh> meshes;
  std::vector<Eigen::Vector3f> points;
  for (const bool touching : {false, true}) {
    for (size_t i = 0; i < play.moments.size(); ++i) {
      const ContactMoment& moment = play.moments[i];
      const bool last = i + 1 == play.moments.size();
      meshes.push_back(mesh_of(character, touching ? moment.touching : moment.alone, moment.boxes,
                               last ? scene.left_out : std::vector<std::string>{}));
      points.insert(points.end(), meshes.back().positions.begin(), meshes.back().positions.end());
    }
  }
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const render::Camera camera = scene.shown.isEmpty()
                                    ? render::camera_around(points, aspect, scene.view)
                                    : render::camera_around(scene.shown, aspect, scene.view);
  const render::RenderOptions options{.width = size.width,
                                      .height = size.height,
                                      .samples = size.samples,
                                      .threads = size.threads,
                                      .studio = render::Studio::facing(scene.view.yaw_deg)};
  std::vector<render::Cell> cells;
  for (size_t i = 0; i < meshes.size(); ++i) {
    const size_t moment = i % play.moments.size();
    const bool without = moment + 1 == play.moments.size() && !scene.left_out.empty();
    char caption[64];
    std::snprintf(caption, sizeof caption, "%.2f s, contacts %s%s", play.moments[moment].time_s,
                  i < play.moments.size() ? "off" : "on", without ? ", arms left out" : "");
    cells.push_back({render::render(meshes[i], camera, options), caption});
  }
  return render::contact_sheet(cells, static_cast<int>(play.moments.size()), scene.title);
}

}  // namespace sinew::sample

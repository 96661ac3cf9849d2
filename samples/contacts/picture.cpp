// picture.cpp  see picture.hpp.
#include "samples/contacts/picture.hpp"

#include <cstdio>

#include "samples/render/layout.hpp"
#include "samples/render/renderer.hpp"

namespace sinew::sample {
namespace {

void append(const render::Mesh& from, render::Mesh* to) {
  const auto first = static_cast<uint32_t>(to->positions.size());
  to->positions.insert(to->positions.end(), from.positions.begin(), from.positions.end());
  to->normals.insert(to->normals.end(), from.normals.begin(), from.normals.end());
  to->colors.insert(to->colors.end(), from.colors.begin(), from.colors.end());
  for (const auto& t : from.triangles) to->triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

render::Mesh mesh_of(const demo::CharacterFile& character, const std::vector<Eigen::Vector3f>& places,
                     const render::Mesh& boxes) {
  render::Mesh mesh = demo::bind_mesh(character);
  mesh.positions = places;
  mesh.normals = render::smooth_normals(places, mesh.triangles, character.view.welded);
  append(boxes, &mesh);
  return mesh;
}

}  // namespace

render::Image picture(const demo::CharacterFile& character, const ContactScene& scene,
                      const ContactPlay& play, const ContactPicture& size) {
  std::vector<render::Mesh> meshes;
  std::vector<Eigen::Vector3f> points;
  for (const bool touching : {false, true}) {
    for (const ContactMoment& moment : play.moments) {
      meshes.push_back(mesh_of(character, touching ? moment.touching : moment.alone, moment.boxes));
      points.insert(points.end(), meshes.back().positions.begin(), meshes.back().positions.end());
    }
  }
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const render::Camera camera = render::camera_around(points, aspect, scene.view);
  const render::RenderOptions options{.width = size.width,
                                      .height = size.height,
                                      .samples = size.samples,
                                      .threads = size.threads,
                                      .studio = render::Studio::facing(scene.view.yaw_deg)};
  std::vector<render::Cell> cells;
  for (size_t i = 0; i < meshes.size(); ++i) {
    const size_t moment = i % play.moments.size();
    char caption[64];
    std::snprintf(caption, sizeof caption, "%.2f s, %s", play.moments[moment].time_s,
                  i < play.moments.size() ? "contacts off" : "contacts on");
    cells.push_back({render::render(meshes[i], camera, options), caption});
  }
  return render::contact_sheet(cells, static_cast<int>(play.moments.size()), scene.title);
}

}  // namespace sinew::sample

// sheet.cpp  see sheet.hpp.
#include "samples/rods/sheet.hpp"

#include "baker/render/picture/layout.hpp"
#include "baker/render/renderer.hpp"
#include "samples/rods/tube.hpp"

namespace sinew::sample {
namespace {

void add_prop(const render::Mesh& prop, const Eigen::Isometry3f& at, render::Mesh* mesh) {
  const auto first = static_cast<uint32_t>(mesh->positions.size());
  for (size_t i = 0; i < prop.positions.size(); ++i) {
    mesh->positions.push_back(at * prop.positions[i]);
    mesh->normals.push_back(at.linear() * prop.normals[i]);
    mesh->colors.push_back(prop.colors[i]);
  }
  for (const auto& [a, b, c] : prop.triangles) mesh->triangles.push_back({first + a, first + b, first + c});
}

render::Mesh mesh_of(const Story& story, const Moment& moment) {
  render::Mesh mesh;
  add_prop(story.prop, moment.prop, &mesh);
  for (size_t k = 0; k < story.actors.size(); ++k) {
    add_tube(story.actors[k], moment.poses[k], &mesh);
    add_leaves(story.actors[k], moment.poses[k], &mesh);
  }
  return mesh;
}

}  // namespace

render::Image sheet(const Story& story, const PictureSize& size) {
  std::vector<render::Mesh> meshes;
  std::vector<Eigen::Vector3f> points;
  for (const Moment& moment : story.moments) {
    meshes.push_back(mesh_of(story, moment));
    points.insert(points.end(), meshes.back().positions.begin(), meshes.back().positions.end());
  }
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const render::Camera camera = render::camera_around(points, aspect, story.view);
  render::RenderOptions options{.width = size.width,
                                .height = size.height,
                                .samples = size.samples,
                                .threads = size.threads,
                                .grid_m = story.grid_m,
                                .studio = render::Studio::facing(story.view.yaw_deg)};
  std::vector<render::Cell> cells;
  for (size_t i = 0; i < meshes.size(); ++i) {
    cells.push_back({render::render(meshes[i], camera, options), story.moments[i].caption});
  }
  return render::contact_sheet(cells, story.columns, story.title);
}

}  // namespace sinew::sample

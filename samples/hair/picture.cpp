// picture.cpp  see picture.hpp.
#include "samples/hair/picture.hpp"

#include "samples/render/renderer.hpp"
#include "samples/rods/tube.hpp"

namespace sinew::sample {
namespace {

const render::Rgb kSkin(0.62f, 0.36f, 0.25f), kShirt(0.10f, 0.17f, 0.24f);
constexpr double kCollar_m = 1.40;

void add_bust(const Hair& hair, render::Mesh* mesh) {
  const std::vector<float> places = hair.bust().places(turning_at(hair.time_s()));
  for (size_t v = 0; v < hair.bust().rest_m.size(); ++v) {
    mesh->positions.emplace_back(places[3 * v], places[3 * v + 1], places[3 * v + 2]);
    const Eigen::Vector3d& rest = hair.bust().rest_m[v];
    mesh->colors.push_back(rest.y() + 0.25 * std::abs(rest.x()) > kCollar_m + 0.045 ? kSkin : kShirt);
  }
  mesh->triangles = hair.bust().triangles;
  mesh->normals = render::smooth_normals(mesh->positions, mesh->triangles);
}

void add_hair(const Hair& hair, render::Mesh* mesh) {
  for (uint32_t s = 0; s < hair.strands().size(); ++s) {
    const float shade = 0.8f + 0.4f * static_cast<float>((s * 7) % 16) / 16;
    const Actor lock{
        hair.strands()[s],
        {shade * render::Rgb(0.17f, 0.07f, 0.03f), shade * render::Rgb(0.22f, 0.1f, 0.04f), 10, 3},
        {}};
    Poses poses;
    for (uint32_t i = 0; i < hair.batch().segment_count(); ++i) poses.push_back(hair.batch().pose(s, i));
    add_tube(lock, poses, mesh);
  }
}

}  // namespace

render::Image picture(const Hair& hair, const HairPicture& size) {
  render::Mesh mesh;
  add_bust(hair, &mesh);
  add_hair(hair, &mesh);
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const Eigen::AlignedBox3f box(Eigen::Vector3f(-0.3f, 1.12f, -0.25f), Eigen::Vector3f(0.3f, 1.78f, 0.25f));
  const render::View view{.yaw_deg = size.yaw_deg, .pitch_deg = 8, .margin = 1.0f};
  return render::render(mesh, render::camera_around(box, aspect, view),
                        {.width = size.width,
                         .height = size.height,
                         .samples = size.samples,
                         .threads = size.threads,
                         .floor_y = 0.9f,
                         .grid_m = 0,
                         .studio = render::Studio::facing(size.yaw_deg)});
}

}  // namespace sinew::sample

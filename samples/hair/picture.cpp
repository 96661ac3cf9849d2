// picture.cpp  see picture.hpp.
#include "samples/hair/picture.hpp"

#include "baker/render/renderer.hpp"
#include "samples/rods/tube.hpp"
#include "tests/scenes/rod_through.hpp"

namespace sinew::sample {
namespace {

const render::Rgb kSkin(0.62f, 0.36f, 0.25f), kShirt(0.10f, 0.17f, 0.24f);
constexpr double kCollar_m = 1.40;

void add_bust(const Bust& bust, const std::vector<float>& places, render::Mesh* mesh) {
  for (size_t v = 0; v < bust.rest_m.size(); ++v) {
    mesh->positions.emplace_back(places[3 * v], places[3 * v + 1], places[3 * v + 2]);
    const Eigen::Vector3d& rest = bust.rest_m[v];
    mesh->colors.push_back(rest.y() + 0.25 * std::abs(rest.x()) > kCollar_m + 0.045 ? kSkin : kShirt);
  }
  mesh->triangles = bust.triangles;
  mesh->normals = render::smooth_normals(mesh->positions, mesh->triangles);
}

void add_lock(const Segments& segments, const Poses& poses, size_t index, render::Mesh* mesh) {
  const float shade = 0.8f + 0.4f * static_cast<float>((index * 7) % 16) / 16;
  const Actor lock{segments,
                   {shade * render::Rgb(0.17f, 0.07f, 0.03f), shade * render::Rgb(0.22f, 0.1f, 0.04f), 10, 3},
                   {}};
  add_tube(lock, poses, mesh);
}

void add_hair(const Hair& hair, render::Mesh* mesh) {
  for (uint32_t s = 0; s < hair.strands().size(); ++s) {
    Poses poses;
    for (uint32_t i = 0; i < hair.batch().segment_count(); ++i) poses.push_back(hair.batch().pose(s, i));
    add_lock(hair.strands()[s], poses, s, mesh);
  }
}

// By where bones begin and end; their roll is not seen.
void add_hair(const TieredHair& hair, render::Mesh* mesh) {
  const TieredHair::Places places = hair.places();
  size_t bone = 0;
  for (size_t s = 0; s < hair.locks().size(); ++s) {
    Segments segments(hair.locks()[s].begin() + 1, hair.locks()[s].end());  // the first is in the head
    std::vector<Eigen::Vector3d> points = {places[2 * bone]};
    for (size_t i = 0; i < segments.size(); ++i) points.push_back(places[2 * bone++ + 1]);
    Poses poses;
    for (const rods::SegmentDef& at : test::rod_through(points, segments[0])) {
      rods::SegmentPose pose;
      std::copy_n(at.position_m, 3, pose.position_m);
      std::copy_n(at.orientation, 4, pose.orientation);
      poses.push_back(pose);
    }
    segments[0].parent = rods::kNoParent;
    for (size_t i = 1; i < segments.size(); ++i) segments[i].parent = static_cast<uint32_t>(i - 1);
    add_lock(segments, poses, s, mesh);
  }
}

render::Image lit(const render::Mesh& mesh, const HairPicture& size) {
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

}  // namespace

render::Image picture(const Hair& hair, const HairPicture& size) {
  render::Mesh mesh;
  add_bust(hair.bust(), hair.bust().places(turning_at(hair.time_s())), &mesh);
  add_hair(hair, &mesh);
  return lit(mesh, size);
}

render::Image picture(const TieredHair& hair, const HairPicture& size) {
  render::Mesh mesh;
  add_bust(hair.bust(), haired_skin(hair.bust(), turning_at(hair.time_s())), &mesh);
  add_hair(hair, &mesh);
  return lit(mesh, size);
}

}  // namespace sinew::sample

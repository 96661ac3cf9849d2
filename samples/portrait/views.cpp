// views.cpp  see views.hpp.
#include "samples/portrait/views.hpp"

#include "baker/common/progress.hpp"

namespace sinew::portrait {
namespace {

// Standing on the floor, whatever height the file puts it at.
render::RenderOptions options_for(const Eigen::AlignedBox3f& box, Paint paint, const PictureSize& size) {
  render::RenderOptions options;
  options.width = size.width;
  options.height = size.height;
  options.samples = size.samples;
  options.threads = size.threads;
  options.floor_y = box.min().y();
  options.grid_m = render::grid_for_height(box.sizes().y());
  options.gloss = paint == Paint::kColors ? 1.0f : 0.2f;
  return options;
}

float aspect_of(const PictureSize& size) {
  return static_cast<float>(size.width) / static_cast<float>(size.height);
}

render::Image take(const render::Mesh& mesh, const render::Camera& camera,
                   const render::RenderOptions& options, Paint paint) {
  render::Image image = render::render(mesh, camera, options);
  if (paint == Paint::kStiffness) {
    render::draw_legend(image, {.title = "stiffness", .low_text = "rigid", .high_text = "soft"});
  }
  return image;
}

std::string seconds(double t_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", t_s);
  return text;
}

}  // namespace

std::vector<render::Cell> sides(const baker::Character& character, const Pose& pose,
                                const PictureSize& size) {
  const render::Mesh mesh = posed_mesh(character, pose.clip, pose.t_s, pose.paint);
  const Eigen::AlignedBox3f box = render::bounding_box(mesh.positions);
  render::RenderOptions options = options_for(box, pose.paint, size);
  const std::pair<const char*, float> yaws[] = {
      {"three quarters", 35}, {"front", 0}, {"side", 90}, {"back", 150}};
  std::vector<render::Cell> cells;
  for (const auto& [name, yaw] : yaws) {
    const render::Camera camera = render::camera_around(mesh.positions, aspect_of(size), {.yaw_deg = yaw});
    options.studio = render::Studio::facing(yaw);
    cells.push_back({take(mesh, camera, options, pose.paint), name});
  }
  return cells;
}

std::vector<render::Cell> turntable(const baker::Character& character, const Pose& pose, int count,
                                    const PictureSize& size) {
  const render::Mesh mesh = posed_mesh(character, pose.clip, pose.t_s, pose.paint);
  Eigen::AlignedBox3f box = render::bounding_box(mesh.positions);
  render::RenderOptions options = options_for(box, pose.paint, size);
  {  // the box of the whole turn, so that the camera keeps its distance
    const Eigen::Vector3f center = box.center();
    const float radius = std::hypot(box.sizes().x(), box.sizes().z()) / 2;
    box.extend(Eigen::Vector3f(center.x() - radius, center.y(), center.z() - radius));
    box.extend(Eigen::Vector3f(center.x() + radius, center.y(), center.z() + radius));
  }
  baker::Progress progress("turning", static_cast<size_t>(count));
  std::vector<render::Cell> cells;
  for (int i = 0; i < count; ++i) {
    const float yaw = 360.0f * static_cast<float>(i) / static_cast<float>(count);
    const render::Camera camera = render::camera_around(box, aspect_of(size), {.yaw_deg = yaw, .margin = 1});
    options.studio = render::Studio::facing(yaw);
    cells.push_back({take(mesh, camera, options, pose.paint), std::to_string(std::lround(yaw)) + " deg"});
    progress.update(static_cast<size_t>(i + 1));
  }
  return cells;
}

std::vector<render::Cell> through_clips(const baker::Character& character, Paint paint, int columns,
                                        const PictureSize& size) {
  baker::Progress progress("clips", character.clips.size());
  std::vector<render::Cell> cells;
  for (const baker::Clip& clip : character.clips) {
    std::vector<render::Mesh> meshes;
    Eigen::AlignedBox3f box;
    for (int i = 0; i < columns; ++i) {
      meshes.push_back(posed_mesh(character, &clip, clip.duration_s * i / columns, paint));
      box.extend(render::bounding_box(meshes.back().positions));
    }
    render::RenderOptions options = options_for(box, paint, size);
    options.floor_y = std::min(0.0f, box.min().y());
    const render::Camera camera = render::camera_around(box, aspect_of(size), {.yaw_deg = 35});
    options.studio = render::Studio::facing(35);
    for (int i = 0; i < columns; ++i) {
      const render::Mesh& mesh = meshes[static_cast<size_t>(i)];
      cells.push_back(
          {take(mesh, camera, options, paint), clip.name + "  " + seconds(clip.duration_s * i / columns)});
    }
    progress.update(cells.size() / static_cast<size_t>(columns));
  }
  return cells;
}

}  // namespace sinew::portrait

// film_set.cpp  see film_set.hpp.
#include "samples/demo/film_set.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "samples/demo/error_chart.hpp"
#include "samples/demo/statistics.hpp"

namespace sinew::demo {
namespace {

constexpr float kYaw_deg = 32;
constexpr double kFarthestInView = 1.5;  // root travel, in heights
constexpr size_t kCameraPoints = 200000;

std::string decimals(double value, const char* format) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-6))));
  for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (value <= digit * decade) return digit * decade;
  }
  return 10 * decade;
}

// Of the soft vertices over all snapshots: what the colours must reach. The largest hundredth may saturate.
double scale_mm(const Run& run, std::span<const uint32_t> soft) {
  std::vector<double> distances;
  const size_t every = std::max<size_t>(1, soft.size() * run.snapshots.size() / kCameraPoints);
  for (const Snapshot& snapshot : run.snapshots) {
    const auto& target = snapshot.truth.empty() ? snapshot.sinew : snapshot.truth;
    for (size_t i = 0; i < soft.size(); i += every) {
      distances.push_back(1000 * static_cast<double>((snapshot.skinned[soft[i]] - target[soft[i]]).norm()));
    }
  }
  return round_up(std::max(spread_of(std::move(distances)).p99, 0.1));
}

bool travels(const Run& run) {
  Eigen::AlignedBox3d box;
  for (const Snapshot& snapshot : run.snapshots)
    box.extend(Eigen::Map<const Eigen::Vector3d>(snapshot.root.position_m));
  return box.sizes().maxCoeff() > kFarthestInView * static_cast<double>(run.asset.height_m);
}

}  // namespace

FilmSet::FilmSet(const CharacterFile& character, const Run& run, float aspect)
    : run_(run),
      mesh_(bind_mesh(character)),
      welded_(character.view.welded.begin(), character.view.welded.end()),
      follow_(travels(run)) {
  options_.floor_y = render::bounding_box(mesh_.positions).min().y();
  options_.grid_m = render::grid_for_height(run.asset.height_m);
  options_.studio = render::Studio::facing(kYaw_deg);
  Positions points;
  const size_t every = std::max<size_t>(1, run.snapshots.size() * mesh_.positions.size() * 2 / kCameraPoints);
  for (const Snapshot& snapshot : run.snapshots) {
    for (const Positions* positions : {&snapshot.skinned, &snapshot.sinew}) {
      const Positions placed = on_floor(snapshot, *positions);
      for (size_t v = 0; v < placed.size(); v += every) points.push_back(placed[v]);
    }
  }
  // Room above for the titles.
  camera_ = render::camera_around(points, aspect, {.yaw_deg = kYaw_deg, .margin = 1.2f});
  camera_.eye.y() += 0.02f * run.asset.height_m;
  camera_.target.y() += 0.02f * run.asset.height_m;
  highest_mm_ = scale_mm(run, moved_vertices(character));
}

FilmSet::Positions FilmSet::on_floor(const Snapshot& snapshot, const Positions& positions) const {
  const double* at = snapshot.root.position_m;
  const Eigen::Vector3f shift(follow_ ? 0 : static_cast<float>(at[0]), static_cast<float>(at[1]),
                              follow_ ? 0 : static_cast<float>(at[2]));
  const Eigen::Quaternionf turn = Eigen::Quaternionf(snapshot.root.rotation_xyzw).normalized();
  Positions out;
  out.reserve(positions.size());
  for (const Eigen::Vector3f& p : positions) out.push_back(turn * p + shift);
  return out;
}

render::Image FilmSet::picture(const Snapshot& snapshot, const Positions& positions,
                               const PanelSize& size) const {
  render::Mesh mesh = mesh_;
  mesh.positions = on_floor(snapshot, positions);
  mesh.normals = render::smooth_normals(mesh.positions, mesh.triangles, welded_);
  render::RenderOptions options = options_;
  options.width = size.width;
  options.height = size.height;
  options.samples = size.samples;
  return render::render(mesh, camera_, options);
}

render::Image FilmSet::distances(const Snapshot& snapshot, const Positions& positions, const Positions& from,
                                 const std::string& title, const PanelSize& size) const {
  render::Mesh mesh = mesh_;
  mesh.positions = on_floor(snapshot, positions);
  mesh.normals = render::smooth_normals(mesh.positions, mesh.triangles, welded_);
  for (size_t v = 0; v < positions.size(); ++v) {
    const float mm = 1000 * (positions[v] - from[v]).norm();
    mesh.colors[v] = render::ramp(mm / static_cast<float>(highest_mm_));
  }
  render::RenderOptions options = options_;
  options.width = size.width;
  options.height = size.height;
  options.samples = std::max(1, size.samples / 2);  // colour is data here, shading only shows the shape
  options.gloss = 0.2f;
  render::Image image = render::render(mesh, camera_, options);
  render::draw_legend(image, {.title = title, .high = highest_mm_});
  return image;
}

std::vector<render::Panel> FilmSet::panels(const Snapshot& s, const PanelSize& size) const {
  const std::string when = s.motion + "  " + decimals(s.time_s, "%.2f s");
  std::vector<render::Panel> out = {{picture(s, s.skinned, size), "Skinning alone", when},
                                    {picture(s, s.sinew, size), "Sinew", ""}};
  if (s.truth.empty()) {
    out.push_back({distances(s, s.sinew, s.skinned, "moved (mm)", size), "Displacement", ""});
    return out;
  }
  const auto mean = [](float mm) { return "mean " + decimals(static_cast<double>(mm), "%.1f mm"); };
  out.push_back({picture(s, s.truth, size), "Ground truth", "finite elements"});
  out.push_back(
      {distances(s, s.skinned, s.truth, "error (mm)", size), "Error of skinning", mean(s.error.skinning_mm)});
  out.push_back(
      {distances(s, s.sinew, s.truth, "error (mm)", size), "Error of Sinew", mean(s.error.sinew_mm)});
  out.push_back({error_chart(run_.frames, s.time_s, size.width, size.height), "", ""});
  return out;
}

size_t FilmSet::liveliest() const {
  const auto liveliness = [](const Snapshot& s) {
    const Positions& target = s.truth.empty() ? s.sinew : s.truth;
    float sum = 0;
    for (size_t v = 0; v < target.size(); ++v) sum += (s.skinned[v] - target[v]).norm();
    return sum;
  };
  const auto best =
      std::max_element(run_.snapshots.begin(), run_.snapshots.end(),
                       [&](const Snapshot& a, const Snapshot& b) { return liveliness(a) < liveliness(b); });
  return static_cast<size_t>(best - run_.snapshots.begin());
}

}  // namespace sinew::demo

// film_set.cpp  see film_set.hpp.
#include "samples/demo/film_set.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "baker/preview/facing.hpp"
#include "baker/preview/pack_mesh.hpp"
#include "samples/demo/error_chart.hpp"
#include "samples/demo/side.hpp"
#include "samples/demo/statistics.hpp"

namespace sinew::demo {
namespace {

constexpr double kFarthestInView = 0.25;  // travel, in heights
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

using Positions = std::vector<Eigen::Vector3f>;

Eigen::Vector3f middle_of(const Positions& positions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : positions) sum += p.cast<double>();
  return (sum / static_cast<double>(std::max<size_t>(1, positions.size()))).cast<float>();
}

Positions in_world(const Snapshot& snapshot, const Positions& positions) {
  const Eigen::Vector3f shift = Eigen::Map<const Eigen::Vector3d>(snapshot.root.position_m).cast<float>();
  const Eigen::Quaternionf turn = Eigen::Quaternionf(snapshot.root.rotation_xyzw).normalized();
  Positions out;
  out.reserve(positions.size());
  for (const Eigen::Vector3f& p : positions) out.push_back(turn * p + shift);
  return out;
}

bool travels(const Run& run) {
  Eigen::AlignedBox3f box;
  for (const Snapshot& snapshot : run.snapshots) box.extend(middle_of(in_world(snapshot, snapshot.skinned)));
  return box.sizes().maxCoeff() > static_cast<float>(kFarthestInView) * run.asset.height_m;
}

// Where the way from a point in the box to one outside of it leaves the box.
Eigen::Vector3f exit_of(const Eigen::AlignedBox3f& box, const Eigen::Vector3f& in,
                        const Eigen::Vector3f& out) {
  float share = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const float way = out[axis] - in[axis], wall = way > 0 ? box.max()[axis] : box.min()[axis];
    if (way != 0) share = std::min(share, (wall - in[axis]) / way);
  }
  return in + share * (out - in);
}

// The outline of what of the surface lies in the box, where triangles are large, too.
void add_within(const Eigen::AlignedBox3f& box, const Positions& surface,
                std::span<const std::array<uint32_t, 3>> triangles, Positions* points) {
  std::vector<bool> is_in(surface.size());
  for (size_t v = 0; v < surface.size(); ++v)
    if ((is_in[v] = box.contains(surface[v]))) points->push_back(surface[v]);
  for (const auto& triangle : triangles)
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
      if (is_in[a] && !is_in[b]) points->push_back(exit_of(box, surface[a], surface[b]));
    }
}

std::vector<uint32_t> vertices_of(const std::vector<baker::Part>& parts) {
  std::vector<uint32_t> out;
  for (const baker::Part& part : parts) out.insert(out.end(), part.vertices.begin(), part.vertices.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

FilmSet::FilmSet(const CharacterFile& character, const Run& run, const Run* other, const std::string& view,
                 float aspect)
    : character_(character),
      run_(run),
      other_(other),
      mesh_(baker::bind_mesh(character.view)),
      welded_(character.view.welded.begin(), character.view.welded.end()),
      follow_(travels(run)) {
  options_.floor_y = render::bounding_box(mesh_.positions).min().y();
  options_.grid_m = render::grid_for_height(run.asset.height_m);
  place_camera(view, aspect);
  const double darkest_mm = 1000 * kDarkest * static_cast<double>(run.asset.height_m);
  displacement_ = {"moved, of height", decimals(100 * kDarkest, "%.0f %%"), darkest_mm};
  if (!run.snapshots.front().truth.empty())
    error_ = {"error (mm)", "", scale_mm(run, soft_vertices(character))};
}

// How far each vertex goes at most from where skinning has it.
std::vector<float> FilmSet::farthest_m() const {
  std::vector<float> farthest(mesh_.positions.size(), 0);
  for (const Run* run : {&run_, other_}) {
    if (run == nullptr) continue;
    for (const Snapshot& s : run->snapshots)
      for (size_t v = 0; v < farthest.size(); ++v)
        farthest[v] = std::max(farthest[v], (s.sinew[v] - s.skinned[v]).norm());
  }
  return farthest;
}

// What moves by itself, and the body around it: enough to tell what is seen. What has flown off does not
// count. Where that is most of the character, all of it: a picture that cuts off a hat looks like a mistake.
void FilmSet::add_framed(const Snapshot& snapshot, std::span<const uint32_t> moved, Positions* points) const {
  constexpr float kOfParts = 0.2f, kOfHeight = 0.25f, kFlownOff = 0.1f, kMostOfBody = 0.5f;
  const Positions placed = on_floor(snapshot, snapshot.skinned), sinew = on_floor(snapshot, snapshot.sinew);
  const float height_m = run_.asset.height_m;
  Eigen::AlignedBox3f around;
  for (const uint32_t v : moved) {
    around.extend(placed[v]);
    if ((sinew[v] - placed[v]).norm() < kFlownOff * height_m) around.extend(sinew[v]);
  }
  if (around.isEmpty()) around = render::bounding_box(placed);
  const float beyond = std::max(kOfParts * around.diagonal().norm(), kOfHeight * height_m);
  around.min().array() -= beyond;
  around.max().array() += beyond;
  const Eigen::AlignedBox3f body = render::bounding_box(placed);
  if (around.intersection(body).diagonal().norm() > kMostOfBody * body.diagonal().norm()) around.extend(body);
  add_within(around, placed, mesh_.triangles, points);
}

void FilmSet::place_camera(const std::string& view, float aspect) {
  const std::vector<float> farthest = farthest_m();
  const float yaw_deg = camera_yaw_deg(view, baker::facing_yaw_deg(character_.view), mesh_, farthest);
  options_.studio = render::Studio::facing(yaw_deg);
  const std::vector<uint32_t> moved = vertices_of(baker::parts_of(character_.view));
  Positions points;
  for (const Snapshot& snapshot : run_.snapshots) add_framed(snapshot, moved, &points);
  // Room above for the titles.
  camera_ =
      render::camera_around(points, aspect, {.yaw_deg = yaw_deg, .pitch_deg = kPitch_deg, .margin = 1.1f});
  camera_.eye.y() += 0.02f * run_.asset.height_m;
  camera_.target.y() += 0.02f * run_.asset.height_m;
}

FilmSet::Positions FilmSet::on_floor(const Snapshot& snapshot, const Positions& positions) const {
  Positions out = in_world(snapshot, positions);
  if (!follow_) return out;
  Eigen::Vector3f travelled = middle_of(in_world(snapshot, snapshot.skinned)) - middle_of(mesh_.positions);
  travelled.y() = 0;
  for (Eigen::Vector3f& p : out) p -= travelled;
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
                                 const Scale& scale, const PanelSize& size) const {
  render::Mesh mesh = mesh_;
  mesh.positions = on_floor(snapshot, positions);
  mesh.normals = render::smooth_normals(mesh.positions, mesh.triangles, welded_);
  for (size_t v = 0; v < positions.size(); ++v) {
    const float mm = 1000 * (positions[v] - from[v]).norm();
    mesh.colors[v] = render::ramp(mm / static_cast<float>(scale.highest_mm));
  }
  render::RenderOptions options = options_;
  options.width = size.width;
  options.height = size.height;
  options.samples = size.samples;
  options.gloss = 0.2f;  // colour is data here, shading only shows the shape
  render::Image image = render::render(mesh, camera_, options);
  render::draw_legend(image, {.title = scale.title, .high = scale.highest_mm, .high_text = scale.high});
  return image;
}

std::vector<render::Panel> FilmSet::panels(size_t snapshot, const PanelSize& size) const {
  const Snapshot& s = run_.snapshots[snapshot];
  const std::string when = s.motion + "  " + decimals(s.time_s, "%.2f s");
  std::vector<render::Panel> out = {{picture(s, s.skinned, size), "Skinning alone", when},
                                    {picture(s, s.sinew, size), other_ == nullptr ? "Sinew" : run_.name, ""}};
  if (other_ != nullptr) {
    const Snapshot& b = other_->snapshots[snapshot];
    out.push_back({picture(b, b.sinew, size), other_->name, ""});
    out.push_back({distances(s, s.sinew, b.sinew,
                             {"apart, of height", displacement_.high, displacement_.highest_mm}, size),
                   "Difference", run_.name + " to " + other_->name});
    out.push_back({distances(s, s.sinew, s.skinned, displacement_, size), "Displacement", run_.name});
    out.push_back({distances(b, b.sinew, b.skinned, displacement_, size), "Displacement", other_->name});
    return out;
  }
  if (s.truth.empty()) {
    out.push_back({distances(s, s.sinew, s.skinned, displacement_, size), "Displacement", ""});
    return out;
  }
  const auto mean = [](float mm) { return "mean " + decimals(static_cast<double>(mm), "%.1f mm"); };
  out.push_back({picture(s, s.truth, size), "Ground truth", "finite elements"});
  out.push_back(
      {distances(s, s.skinned, s.truth, error_, size), "Error of skinning", mean(s.error.skinning_mm)});
  out.push_back({distances(s, s.sinew, s.truth, error_, size), "Error of Sinew", mean(s.error.sinew_mm)});
  out.push_back({error_chart(run_.frames, s.time_s, size.width, size.height), "", ""});
  return out;
}

size_t FilmSet::liveliest(size_t first, size_t end) const {
  const auto liveliness = [](const Snapshot& s) {
    const Positions& target = s.truth.empty() ? s.sinew : s.truth;
    float sum = 0;
    for (size_t v = 0; v < target.size(); ++v) sum += (s.skinned[v] - target[v]).norm();
    return sum;
  };
  const auto of_range = std::span(run_.snapshots).subspan(first, end - first);
  return first + static_cast<size_t>(std::ranges::max_element(of_range, {}, liveliness) - of_range.begin());
}

std::string FilmSet::motions() const {
  std::string out;
  for (size_t s = 0; s < run_.snapshots.size(); ++s) {
    const std::string& motion = run_.snapshots[s].motion;
    if (s == 0 || motion != run_.snapshots[s - 1].motion) out += (out.empty() ? "" : ", ") + motion;
  }
  return out;
}

std::string FilmSet::scale() const {
  return "darkest: " + displacement_.high + " of the height, " +
         render::short_number(displacement_.highest_mm) + " mm";
}

}  // namespace sinew::demo

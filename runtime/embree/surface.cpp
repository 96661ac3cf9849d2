// surface.cpp  Checks, places and moves; Embree's tree holds each triangle's box over the tick.
#include "embree/surface.hpp"

#include <algorithm>
#include <cmath>

#include "core/status.hpp"
#include "rods/vector.hpp"

namespace sinew::embree {
namespace {

using core::make_status;

constexpr size_t kMostTriangles = size_t{1} << 26;
constexpr float kFarthest_m = 1e6f;

Status check_numbers(const char* what, std::span<const float> places_m) {
  for (size_t i = 0; i < places_m.size(); ++i) {
    if (std::fabs(places_m[i]) <= kFarthest_m) continue;
    return make_status(std::isfinite(places_m[i]) ? StatusCode::kInvalidArgument : StatusCode::kNotFinite,
                       "%s of vertex %zu is %g; give numbers within +-1e6", what, i / 3,
                       static_cast<double>(places_m[i]));
  }
  return {};
}

Status check_sizes(const SurfaceDef& def) {
  const size_t triangles = def.triangles.size() / 3;
  if (def.triangles.empty() || def.triangles.size() % 3 != 0 || triangles > kMostTriangles) {
    return make_status(StatusCode::kInvalidArgument,
                       "triangles has %zu indices; give three a triangle, 1 to %zu of them",
                       def.triangles.size(), kMostTriangles);
  }
  if (def.rest_m.empty() || def.rest_m.size() % 3 != 0) {
    return make_status(StatusCode::kInvalidArgument, "rest_m has %zu numbers; give x y z of each vertex",
                       def.rest_m.size());
  }
  if (def.groups.empty() || def.groups.size() == triangles) return {};
  return make_status(StatusCode::kInvalidArgument,
                     "groups has %zu numbers for %zu triangles; give one for each, or none",
                     def.groups.size(), triangles);
}

Status check_indices(const SurfaceDef& def) {
  const size_t vertices = def.rest_m.size() / 3;
  for (size_t i = 0; i < def.triangles.size(); ++i) {
    if (def.triangles[i] < vertices) continue;
    return make_status(StatusCode::kInvalidArgument,
                       "triangle %zu names vertex %u of %zu; give indices that are there", i / 3,
                       def.triangles[i], vertices);
  }
  return {};
}

Status check_pair(const SurfaceDef& def) {
  if (!(def.friction >= 0) || !std::isfinite(def.friction)) {
    return make_status(StatusCode::kInvalidArgument, "friction is %g; give a finite number, 0 or more",
                       static_cast<double>(def.friction));
  }
  if (def.restitution >= 0 && def.restitution <= 1) return {};
  return make_status(StatusCode::kInvalidArgument, "restitution is %g; give 0 to 1",
                     static_cast<double>(def.restitution));
}

Status check(const SurfaceDef& def) {
  Status status = check_sizes(def);
  if (status.ok()) status = check_indices(def);
  if (status.ok()) status = check_numbers("rest_m", def.rest_m);
  return status.ok() ? check_pair(def) : status;
}

// Six times what the triangles enclose.
double volume(const Topology& topology, std::span<const float> places_m) {
  double sum = 0;
  for (const Corners& t : topology.triangles) {
    Vector c[3];
    for (size_t k = 0; k < 3; ++k)
      c[k] = {places_m[3 * t[k]], places_m[3 * t[k] + 1], places_m[3 * t[k] + 2]};
    sum += rods::dot(c[0], rods::cross(c[1], c[2]));
  }
  return sum;
}

Status check_shape(const Topology& topology, const SurfaceDef& def) {
  if (topology.triangles.empty()) {
    return make_status(StatusCode::kInvalidArgument,
                       "none of the %zu triangles has an area at rest; give some that have",
                       def.triangles.size() / 3);
  }
  const bool closed = topology.border_edges == 0 && !def.two_sided;
  if (!closed || volume(topology, def.rest_m) > 0) return {};
  return make_status(
      StatusCode::kInvalidArgument,
      "the closed surface of %zu triangles is inside out; turn them counter-clockwise as seen from outside",
      def.triangles.size() / 3);
}

Status check(const SurfacePose& pose, size_t numbers) {
  if (pose.places_m.size() != numbers) {
    return make_status(StatusCode::kInvalidArgument,
                       "places_m has %zu numbers; give x y z of all %zu vertices", pose.places_m.size(),
                       numbers / 3);
  }
  if (!(pose.dt_s >= 0 && pose.dt_s <= 1)) {
    return make_status(StatusCode::kInvalidArgument, "dt_s is %g; give 0 to 1",
                       static_cast<double>(pose.dt_s));
  }
  for (const double x : pose.origin_m) {
    if (!std::isfinite(x))
      return make_status(StatusCode::kNotFinite, "origin_m is %g; give finite numbers", x);
  }
  return check_numbers("places_m", pose.places_m);
}

}  // namespace

Status Surface::create(RTCDevice device, const SurfaceDef& def, std::unique_ptr<Surface>* out) {
  Status status = check(def);
  if (!status.ok()) return status;
  std::unique_ptr<Surface> made(new Surface);
  made->topology_ = connect(def.triangles, def.rest_m);
  status = check_shape(made->topology_, def);
  if (!status.ok()) return status;
  if (!def.groups.empty()) {
    for (const uint32_t source : made->topology_.source) made->groups_.push_back(def.groups[source]);
  }
  made->rest_m_.assign(def.rest_m.begin(), def.rest_m.end());
  made->starts_ = made->last_ = made->rest_m_;
  made->moves_.assign(def.rest_m.size(), 0);
  made->friction_ = def.friction, made->restitution_ = def.restitution, made->two_sided_ = def.two_sided;
  if (!made->build(device)) return make_status(StatusCode::kOutOfCapacity, "no memory for a surface's tree");
  *out = std::move(made);
  return {};
}

Surface::~Surface() {
  if (geometry_) rtcReleaseGeometry(geometry_);
  if (scene_) rtcReleaseScene(scene_);
}

bool Surface::build(RTCDevice device) noexcept {
  scene_ = rtcNewScene(device);
  geometry_ = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  if (!scene_ || !geometry_) return false;
  // Embree refits geometries of dynamic scenes of low quality alone, and builds the others anew: 20 times as
  // long.
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
  rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<uint32_t>(topology_.triangles.size()));
  rtcSetGeometryUserData(geometry_, this);
  rtcSetGeometryBoundsFunction(geometry_, bound, nullptr);
  rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
  rtcAttachGeometry(scene_, geometry_);
  commit();
  return rtcGetDeviceError(device) == RTC_ERROR_NONE;
}

void Surface::bound(const RTCBoundsFunctionArguments* args) {
  const Surface& s = *static_cast<const Surface*>(args->geometryUserPtr);
  float low[3], high[3];
  for (size_t k = 0; k < 3; ++k) low[k] = std::numeric_limits<float>::infinity(), high[k] = -low[k];
  for (const uint32_t v : s.topology_.triangles[args->primID]) {
    for (size_t k = 0; k < 3; ++k) {
      const float start = s.starts_[3 * size_t{v} + k], end = start + s.moves_[3 * size_t{v} + k];
      low[k] = std::min({low[k], start, end}), high[k] = std::max({high[k], start, end});
    }
  }
  *args->bounds_o = {low[0], low[1], low[2], 0, high[0], high[1], high[2], 0};
}

void Surface::commit() noexcept {
  rtcCommitGeometry(geometry_);
  rtcCommitScene(scene_);
  RTCBounds bounds;
  rtcGetSceneBounds(scene_, &bounds);
  low_m_[0] = bounds.lower_x, low_m_[1] = bounds.lower_y, low_m_[2] = bounds.lower_z;
  high_m_[0] = bounds.upper_x, high_m_[1] = bounds.upper_y, high_m_[2] = bounds.upper_z;
}

bool Surface::may_reach(const Vector& middle_m, double radius_m) const noexcept {
  double square = 0;
  for (size_t k = 0; k < 3; ++k) {
    const double out = std::max(
        {static_cast<double>(low_m_[k]) - middle_m[k], middle_m[k] - static_cast<double>(high_m_[k]), 0.0});
    square += out * out;
  }
  return square <= radius_m * radius_m;
}

Status Surface::move(const SurfacePose& pose) noexcept {
  const Status status = check(pose, rest_m_.size());
  if (!status.ok()) {
    ++poses_refused_;
    return status;
  }
  place(pose);
  commit();
  return {};
}

// Differences of places about different origins, in double.
void Surface::place(const SurfacePose& pose) noexcept {
  const bool moves = pose.dt_s > 0, ahead = pose.time == SurfaceTime::kTickEnd;
  for (size_t i = 0; i < last_.size(); ++i) {
    const double shift = origin_m_[i % 3] - pose.origin_m[i % 3];
    const float here = pose.places_m[i], before = static_cast<float>(static_cast<double>(last_[i]) + shift);
    moves_[i] = moves ? here - before : 0;
    starts_[i] = moves && ahead ? before : here;
    last_[i] = here;
  }
  std::copy_n(pose.origin_m, 3, origin_m_);
  double longest = 0;
  for (uint32_t v = 0; v < moves_.size() / 3; ++v) {
    const Vector move = vector(moves_, v);
    longest = std::max(longest, rods::dot(move, move));
  }
  longest_move_m_ = std::sqrt(longest);
  motion_s_ = static_cast<double>(pose.dt_s);
}

Triangle Surface::start_triangle(uint32_t triangle) const noexcept {
  const Corners& t = topology_.triangles[triangle];
  return {{start(t[0]), start(t[1]), start(t[2])}};
}

MovingTriangle Surface::moving_triangle(uint32_t triangle, double share) const noexcept {
  MovingTriangle out = {start_triangle(triangle), {}};
  for (size_t k = 0; k < 3; ++k) {
    out.moves[k] = rods::scaled(share, vector(moves_, topology_.triangles[triangle][k]));
  }
  return out;
}

Triangle Surface::rest_triangle(uint32_t triangle) const noexcept {
  const Corners& t = topology_.triangles[triangle];
  return {{vector(rest_m_, t[0]), vector(rest_m_, t[1]), vector(rest_m_, t[2])}};
}

SurfaceReport Surface::report() const noexcept {
  const Topology& t = topology_;
  const size_t each_triangle = sizeof(Corners) * 2 + sizeof(uint32_t) * (groups_.empty() ? 1 : 2);
  return {static_cast<uint32_t>(t.triangles.size()), t.skipped, t.border_edges, poses_refused_,
          t.triangles.size() * each_triangle + (t.fan.size() + t.fan_begin.size()) * sizeof(uint32_t) +
              t.border.size() + 4 * rest_m_.size() * sizeof(float)};
}

}  // namespace sinew::embree

// surface.cpp  Checks, places and moves; Embree's tree holds each triangle's box over the tick.
#include "adapters/embree/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/status.hpp"
#include "kernels/kernels.hpp"
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

Status Surface::create(const SurfaceDef& def, std::unique_ptr<Surface>* out) {
  Status status = check(def);
  if (!status.ok()) return status;
  std::unique_ptr<Surface> made(new Surface);
  made->topology_ = connect(def.triangles, def.rest_m);
  status = check_shape(made->topology_, def);
  if (!status.ok()) return status;
  if (!def.groups.empty()) {
    made->every_group_ = 0;
    for (const uint32_t source : made->topology_.source) {
      made->groups_.push_back(def.groups[source]);
      made->every_group_ |= def.groups[source];
      made->some_ungrouped_ |= def.groups[source] == 0;
    }
  }
  made->rest_m_.assign(def.rest_m.begin(), def.rest_m.end());
  made->starts_ = made->last_ = made->rest_m_;
  made->moves_.assign(def.rest_m.size(), 0);
  made->friction_ = def.friction, made->restitution_ = def.restitution, made->two_sided_ = def.two_sided;
  made->walks_ = simd::kernels().surface_walks;
  made->tree_.build(made->topology_, def.rest_m, made->groups_);
  made->refit();
  *out = std::move(made);
  return {};
}

void Surface::refit() noexcept {
  tree_.refit(topology_, starts_, moves_, drift_);
  farthest_m_ = 0;
  for (size_t k = 0; k < 3; ++k) {
    farthest_m_ += std::max(std::fabs(tree_.low_m()[k]), std::fabs(tree_.high_m()[k]));
  }
}

bool Surface::may_reach(const Vector& middle_m, double radius_m) const noexcept {
  double square = 0;
  for (size_t k = 0; k < 3; ++k) {
    const double out = std::max({static_cast<double>(tree_.low_m()[k]) - middle_m[k],
                                 middle_m[k] - static_cast<double>(tree_.high_m()[k]), 0.0});
    square += out * out;
  }
  const double within = radius_m + static_cast<double>(rounding_m(middle_m));
  return square <= within * within;
}

Surface::Glance Surface::glance(const Vector& point_m, uint32_t groups, double within_m,
                                uint32_t guess) const noexcept {
  simd::SurfacePoint of = as_point(point_m);
  of.within_m = static_cast<float>(within_m * (1 + 1e-6)) + of.rounding_m;
  simd::SurfaceWalk walk;
  walk.begin(groups, leaf_near(guess));
  walks_->nearest(tree_.view(), &of, &walk);
  Glance out = {kBorder, 0, walk.done()};
  float least = std::numeric_limits<float>::infinity();
  for (uint32_t i = 0; i < walk.found_count; ++i) {
    out.outside = out.outside && walk.above[i];
    if (walk.at_least_m[i] < least) least = walk.at_least_m[i], out.triangle = walk.found[i];
  }
  out.at_least_m = walk.done() ? static_cast<double>(least - 2 * of.rounding_m) : 0;
  return out;
}

simd::SurfaceSweep Surface::without_drift(const Sweep& sweep, double share, double within_m) const noexcept {
  const Vector* starts[2] = {&sweep.start.from, &sweep.start.to};
  const Vector ends[2] = {rods::difference(sweep.end.from, drift(share)),
                          rods::difference(sweep.end.to, drift(share))};
  float rounding = 0;
  for (size_t e = 0; e < 2; ++e) rounding = std::max({rounding, rounding_m(*starts[e]), rounding_m(ends[e])});
  simd::SurfaceSweep out;
  out.within_m = static_cast<float>(within_m) + 2 * rounding;
  out.share = static_cast<float>(share);
  for (size_t k = 0; k < 3; ++k) {
    for (size_t e = 0; e < 2; ++e) {
      out.start_m[e][k] = static_cast<float>((*starts[e])[k]),
      out.end_m[e][k] = static_cast<float>(ends[e][k]);
    }
    const auto [low, high] =
        std::minmax({out.start_m[0][k], out.start_m[1][k], out.end_m[0][k], out.end_m[1][k]});
    out.low_m[k] = low - out.within_m, out.high_m[k] = high + out.within_m;
  }
  return out;
}

Status Surface::move(const SurfacePose& pose) noexcept {
  const Status status = check(pose, rest_m_.size());
  if (!status.ok()) {
    ++poses_refused_;
    return status;
  }
  place(pose);
  if (!changed_) return {};
  measure_moves();
  refit();
  return {};
}

// Differences of places about different origins, in double.
void Surface::place(const SurfacePose& pose) noexcept {
  const bool moves = pose.dt_s > 0, ahead = pose.time == SurfaceTime::kTickEnd;
  Vector shift;
  for (size_t k = 0; k < 3; ++k) shift[k] = origin_m_[k] - pose.origin_m[k];
  changed_ = false;
  for (size_t v = 0; v < last_.size(); v += 3) {
    for (size_t k = 0; k < 3; ++k) {
      const size_t i = v + k;
      const float here = pose.places_m[i],
                  before = static_cast<float>(static_cast<double>(last_[i]) + shift[k]);
      const float move = moves ? here - before : 0, start = moves && ahead ? before : here;
      changed_ |= (move != moves_[i]) | (start != starts_[i]);
      moves_[i] = move, starts_[i] = start, last_[i] = here;
    }
  }
  std::copy_n(pose.origin_m, 3, origin_m_);
  motion_s_ = static_cast<double>(pose.dt_s);
}

// Of a character that runs, all moves by about as much.
void Surface::measure_moves() noexcept {
  Vector total = {};
  for (uint32_t v = 0; v < moves_.size() / 3; ++v) total = rods::sum(total, vector(moves_, v));
  for (size_t k = 0; k < 3; ++k)
    drift_[k] = static_cast<float>(3 * total[k] / static_cast<double>(moves_.size()));
  double longest = 0;
  for (uint32_t v = 0; v < moves_.size() / 3; ++v) {
    const Vector move = rods::difference(vector(moves_, v), drift(1));
    longest = std::max(longest, rods::dot(move, move));
  }
  longest_own_move_m_ = std::sqrt(longest);
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
              t.border.size() + 4 * rest_m_.size() * sizeof(float) + tree_.bytes()};
}

}  // namespace sinew::embree

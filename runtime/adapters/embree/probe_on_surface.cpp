// probe_on_surface.cpp  see probe_on_surface.hpp.
#include "adapters/embree/probe_on_surface.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>
#include <utility>

#include "rods/vector.hpp"

namespace sinew::embree {
namespace {

using namespace rods;

// What comes this near is a contact: shares of the radius and of the way relative to the surface.
constexpr double kNearRadius = 0.25, kNearWay = 0.25;
// A touch nearer to another than this share of the axis is left out unless it is deeper.
constexpr double kAtEnd = 0.15;
// A touch is left out where it is no deeper by this, of the radius, than the line between those beside it.
constexpr double kDeeper = 0.01;
// Cosine: contacts that keep something fast from the same.
constexpr double kSameWay = 0.9;
// Of the radius: gaps that count as the same.
constexpr double kSame = 1e-3;
// Of the radius: an axis that is so deep may go through the surface.
constexpr double kCrossing = 0.9;
constexpr double kMeeting = 1e-9;  // m: a distance without a direction

Vector relative_to(const double (&point_m)[3], const double (&origin_m)[3]) {
  return {point_m[0] - origin_m[0], point_m[1] - origin_m[1], point_m[2] - origin_m[2]};
}

Sweep sweep_of(const ContactProbe& probe, const double (&origin_m)[3]) {
  return {{relative_to(probe.start_m[0], origin_m), relative_to(probe.start_m[1], origin_m)},
          {relative_to(probe.end_m[0], origin_m), relative_to(probe.end_m[1], origin_m)},
          static_cast<double>(probe.radius_m)};
}

Vector unit_or(const Vector& v, const Vector& otherwise) {
  const double size = length(v);
  return size > kMeeting ? scaled(1 / size, v) : otherwise;
}

double share_of(const ContactHit& hit) { return 0.5 + 0.5 * static_cast<double>(hit.along); }

Ball ball_about(const Triangle& t) {
  Ball ball = {scaled(1.0 / 3, sum(t.corners[0], sum(t.corners[1], t.corners[2]))), 0};
  for (const Vector& c : t.corners) {
    const Vector arm = difference(c, ball.middle);
    ball.radius_m = std::max(ball.radius_m, dot(arm, arm));
  }
  ball.radius_m = std::sqrt(ball.radius_m);
  return ball;
}

bool comes_before(const TriangleTouch& a, const TriangleTouch& b) {
  if (a.touches && b.touches && (a.time > 0 || b.time > 0)) return a.arrives < b.arrives;
  return a.touches == b.touches ? a.gap_m < b.gap_m : a.touches;
}

}  // namespace

double Ball::gap_m(const Vector& point) const { return length(difference(point, middle)) - radius_m; }

ProbeOnSurface::ProbeOnSurface(const Surface& surface, const ContactProbe& probe, const SurfaceFilter& filter,
                               uint32_t roots, double reach_m, double dt_s, uint32_t guess,
                               bool from_outside) noexcept
    : surface_(surface),
      filter_(filter),
      roots_(roots),
      guess_(guess),
      reach_m_(reach_m),
      share_(surface.motion_s() > 0 ? std::min(1.0, dt_s / surface.motion_s()) : 0),
      sweep_(sweep_of(probe, surface.origin_m())) {
  closed_ = !surface.two_sided() && surface.is_closed(filter.groups);
  from_outside_ = closed_ && from_outside;
  half_m_ = 0.5 * length(difference(sweep_.start.to, sweep_.start.from));
  const Vector drift = surface.drift(share_);
  const Vector from = difference(difference(sweep_.end.from, sweep_.start.from), drift);
  const Vector to = difference(difference(sweep_.end.to, sweep_.start.to), drift);
  speed_m_ = std::max(length(from), length(to)) + share_ * surface.longest_own_move_m();
  round_ = !(half_m_ > 0) && std::equal(probe.end_m[0], probe.end_m[0] + 3, probe.end_m[1]);
  for (Nearby& n : samples_) n.distance_m = reach_m_;
  samples_[kMiddle].distance_m = std::max(reach_m_, farthest_touch());
}

Vector ProbeOnSurface::sample(uint32_t where) const {
  return between(sweep_.start.from, sweep_.start.to, along(where));
}

Sweep ProbeOnSurface::sweep_of_end(uint32_t where) const {
  const Vector start = where == kFrom ? sweep_.start.from : sweep_.start.to;
  const Vector end = where == kFrom ? sweep_.end.from : sweep_.end.to;
  return {{start, start}, {end, end}, sweep_.radius_m};
}

// An axis that has this much more way than a triangle touches it from no further.
double ProbeOnSurface::near_m(double speed_m) const noexcept {
  return (1 + kNearRadius) * sweep_.radius_m + (1 + kNearWay) * speed_m;
}

// What comes from further off than this from the middle of the axis does not touch.
double ProbeOnSurface::farthest_touch() const noexcept { return half_m_ + near_m(speed_m_); }

void ProbeOnSurface::look_at_sample(uint32_t where, uint32_t triangle) noexcept {
  const Vector point = sample(where);
  const OnTriangle on = embree::nearest(surface_.start_triangle(triangle), point);
  const double distance = length(difference(point, on.point));
  Nearby& best = samples_[where];
  const bool first_of_same = distance == best.distance_m && triangle < best.triangle;
  if (distance < best.distance_m || first_of_same) best = {distance, triangle, on};
}

void ProbeOnSurface::find_nearest(uint32_t where) noexcept {
  const uint32_t guess = glance_.triangle == kNone ? axis_.triangle : glance_.triangle;
  surface_.visit_nearest(sample(where), filter_.groups, guess, &samples_[where].distance_m,
                         [&](uint32_t triangle) { look_at_sample(where, triangle); });
}

// Whether a triangle stays behind what is touched best, along that touch's normal, for as long as it matters.
bool ProbeOnSurface::is_beaten(const Touched& best, const Sweep& sweep,
                               const MovingTriangle& m) const noexcept {
  const Vector& n = best.touch.normal;
  if (best.triangle == kNone || !(dot(n, n) > 0)) return false;
  for (const double time : {0.0, best.touch.touches ? best.touch.time : 1.0}) {
    const double axis = std::min(dot(n, between(sweep.start.from, sweep.end.from, time)),
                                 dot(n, between(sweep.start.to, sweep.end.to, time)));
    double most = -std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 3; ++k)
      most = std::max(most, dot(n, scaled_sum(time, m.moves[k], m.start.corners[k])));
    if (axis - most - sweep.radius_m < best.touch.gap_m - kSame * sweep.radius_m) return false;
  }
  return true;
}

// The axis is no nearer to the triangle than that where the tick begins.
void ProbeOnSurface::look_at_ways(uint32_t triangle, double axis_m) noexcept {
  const MovingTriangle moving = surface_.moving_triangle(triangle, share_);
  const double near = near_m(closing_speed(sweep_, moving));
  const auto look = [&](const Sweep& sweep, Touched* best) {
    if (is_beaten(*best, sweep, moving)) return;
    take_first({first_touch(sweep, moving), triangle}, best);
  };
  if (axis_m > near) return;
  look(sweep_, &axis_);
  if (round_) return;
  const Ball about = ball_about(moving.start);
  for (const uint32_t end : {kFrom, kTo}) {
    if (about.gap_m(sample(end)) <= near) look(sweep_of_end(end), &ends_[end]);
  }
}

// Nearest first: most of the others are behind those.
void ProbeOnSurface::look_at_nearest_first(std::span<const uint32_t> triangles) noexcept {
  struct Candidate {
    double axis_m;
    uint32_t triangle;
  } order[simd::SurfaceWalk::kMostFound];
  uint32_t count = 0;
  for (const uint32_t triangle : triangles) {
    const Ball about = ball_about(surface_.start_triangle(triangle));
    const double along = rods::nearest(sweep_.start, about.middle);
    order[count++] = {about.gap_m(between(sweep_.start.from, sweep_.start.to, along)), triangle};
  }
  std::sort(order, order + count, [](const Candidate& a, const Candidate& b) {
    return std::pair(a.axis_m, a.triangle) < std::pair(b.axis_m, b.triangle);
  });
  for (const Candidate& c : std::span(order, count)) look_at_ways(c.triangle, c.axis_m);
}

void ProbeOnSurface::find_touches() noexcept {
  const double within = near_m(speed_m_) - speed_m_ + kSame * sweep_.radius_m;
  surface_.visit_near(sweep_, share_, within, filter_.groups,
                      [&](std::span<const uint32_t> triangles) { look_at_nearest_first(triangles); });
}

// Whether the axis goes through the surface where the tick begins.
bool ProbeOnSurface::crosses() const noexcept {
  return axis_.triangle != kNone && axis_.touch.gap_m <= -kCrossing * sweep_.radius_m;
}

void ProbeOnSurface::take_first(const Touched& t, Touched* best) const noexcept {
  if (best->triangle == kNone || comes_before(t.touch, best->touch)) *best = t;
}

bool ProbeOnSurface::is_inside(uint32_t where) const noexcept {
  const Nearby& n = samples_[where];
  if (n.triangle == kNone || n.distance_m > reach_m_) return false;
  return side_of(surface_, filter_.groups, n.triangle, n.on, sample(where)) == Side::kInside;
}

void ProbeOnSurface::tell_side(uint32_t where) noexcept {
  find_nearest(where);
  samples_[where].inside = is_inside(where);
}

void ProbeOnSurface::tell_sides_of_ends() noexcept {
  if (round_ || surface_.two_sided()) return;
  if (outside_) return;
  for (const uint32_t end : {kFrom, kTo}) {
    if (!surface_.glance(sample(end), filter_.groups, reach_m_, glance_.triangle).outside) tell_side(end);
  }
}

bool ProbeOnSurface::grows_from(uint32_t triangle, const OnTriangle& on) const noexcept {
  if (roots_ == 0) return false;
  const Vector rest = weighted(surface_.rest_triangle(triangle).corners, on.weights);
  for (uint32_t left = roots_; left != 0; left &= left - 1) {
    const SurfaceRoot& root = filter_.roots[std::countr_zero(left)];
    if (length(difference(rest, vector_of(root.place_m))) < static_cast<double>(root.radius_m)) return true;
  }
  return false;
}

// Of the probe less the surface, in a tick.
Vector ProbeOnSurface::relative_way(uint32_t triangle, const std::array<double, 3>& weights,
                                    double along) const noexcept {
  const Vector way = between(difference(sweep_.end.from, sweep_.start.from),
                             difference(sweep_.end.to, sweep_.start.to), along);
  return difference(way, weighted(surface_.moving_triangle(triangle, share_).moves, weights));
}

bool ProbeOnSurface::near(uint32_t triangle, const OnTriangle& on, double along,
                          double gap_m) const noexcept {
  if (grows_from(triangle, on)) return false;
  const double way = length(relative_way(triangle, on.weights, along));
  return gap_m <= kNearRadius * sweep_.radius_m + kNearWay * way;
}

bool ProbeOnSurface::near(const Touched& t) const noexcept {
  return t.triangle != kNone && near(t.triangle, t.touch.at.on, t.touch.at.along, t.touch.gap_m);
}

void ProbeOnSurface::put(uint32_t triangle, const std::array<double, 3>& weights, double along,
                         const Vector& normal, double gap_m, uint32_t name) noexcept {
  ContactHit& hit = hits_[count_++];
  hit = {};
  hit.along = static_cast<float>(round_ ? 0 : 2 * along - 1);
  hit.gap_m = gap_m;
  const Vector velocity =
      surface_.motion_s() > 0
          ? scaled(1 / surface_.motion_s(), weighted(surface_.moving_triangle(triangle, 1).moves, weights))
          : Vector{};
  for (size_t k = 0; k < 3; ++k) {
    hit.normal[k] = static_cast<float>(normal[k]);
    hit.velocity_m_s[k] = static_cast<float>(velocity[k]);
  }
  hit.friction = surface_.friction(), hit.restitution = surface_.restitution();
  hit.name = name;
  hit.body = surface_.topology().source[triangle];
}

// The gap is along the touch's normal, where the tick begins.
ProbeOnSurface::AtStart ProbeOnSurface::at_start(const Touched& t, uint32_t name) const noexcept {
  const double along = name == kMiddle ? t.touch.at.along : Where{name} == kFrom ? 0 : 1;
  const Vector point = between(sweep_.start.from, sweep_.start.to, along);
  const Vector there = weighted(surface_.start_triangle(t.triangle).corners, t.touch.at.on.weights);
  Vector normal = t.touch.normal;
  if (t.touch.at.distance_m <= kMeeting) {  // the axis crosses something thin, or lies on it
    const Vector out = pseudonormal(surface_, filter_.groups, t.triangle, kFace);
    normal = dot(difference(sample(kMiddle), there), out) < -kMeeting ? scaled(-1, out) : out;
  }
  return {along, normal, dot(difference(point, there), normal) - sweep_.radius_m};
}

void ProbeOnSurface::add(const Touched& t, const AtStart& s, uint32_t name) noexcept {
  if (!(dot(s.normal, s.normal) > 0)) return;
  put(t.triangle, t.touch.at.on.weights, s.along, s.normal, s.gap_m, name);
}

void ProbeOnSurface::add_way_out(uint32_t where) noexcept {
  const Nearby& n = samples_[where];
  if (grows_from(n.triangle, n.on)) return;
  const Vector face = pseudonormal(surface_, filter_.groups, n.triangle, kFace);
  const Vector normal = unit_or(difference(n.on.point, sample(where)), face);
  if (!(dot(normal, normal) > 0)) return;
  put(n.triangle, n.on.weights, along(where), normal, -n.distance_m - sweep_.radius_m, where);
}

bool ProbeOnSurface::Facing::is_that_of(const ContactHit& hit) const noexcept {
  return dot(vector_of(hit.normal), normal) >= least_cosine;
}

// What goes past the ends of an axis is near them where the tick begins, and keeps nothing from going through
// its middle.
ProbeOnSurface::Facing ProbeOnSurface::facing_of(const Touched& t, const AtStart& start) const noexcept {
  const double way = length(relative_way(t.triangle, t.touch.at.on.weights, start.along));
  return way > sweep_.radius_m ? Facing{start.normal, kSameWay} : Facing{};
}

// As deep as this is told next to it already, but for a little.
bool ProbeOnSurface::is_told_beside(double along, double gap_m, const Facing& facing) const noexcept {
  return std::ranges::any_of(std::span(hits_, count_), [&](const ContactHit& hit) {
    return facing.is_that_of(hit) && std::fabs(share_of(hit) - along) < kAtEnd &&
           hit.gap_m < gap_m + kDeeper * sweep_.radius_m;
  });
}

// Contacts on both sides keep the axis from going deeper there, but for a little.
bool ProbeOnSurface::is_told_between(double along, double gap_m, const Facing& facing) const noexcept {
  const ContactHit *before = nullptr, *after = nullptr;
  for (const ContactHit& hit : std::span(hits_, count_)) {
    if (!facing.is_that_of(hit)) continue;
    if (share_of(hit) <= along && (!before || hit.along > before->along)) before = &hit;
    if (share_of(hit) >= along && (!after || hit.along < after->along)) after = &hit;
  }
  if (!before || !after || before == after) return is_told_beside(along, gap_m, facing);
  const double share = (along - share_of(*before)) / (share_of(*after) - share_of(*before));
  return (1 - share) * before->gap_m + share * after->gap_m < gap_m + kDeeper * sweep_.radius_m;
}

void ProbeOnSurface::add_axis() noexcept {
  if (!near(axis_)) return;
  const AtStart start = at_start(axis_, kMiddle);
  const Facing facing = facing_of(axis_, start);
  if (is_told_beside(start.along, start.gap_m, facing)) return;
  if (is_told_between(start.along, start.gap_m, facing)) return;
  add(axis_, start, kMiddle);
}

// An axis on its way to lie on a ridge or a bulge touches it first near one end.
void ProbeOnSurface::add_middle() noexcept {
  const double near_enough = near_m(speed_m_) - speed_m_;
  if (round_ || glance_.at_least_m > near_enough) return;
  Nearby& n = samples_[kMiddle];
  if (n.triangle == kNone) {
    n.distance_m = near_enough;
    find_nearest(kMiddle);
  }
  const double gap = n.distance_m - sweep_.radius_m;
  if (n.triangle == kNone || is_told_between(0.5, gap, {}) || !near(n.triangle, n.on, 0.5, gap)) return;
  const Vector face = pseudonormal(surface_, filter_.groups, n.triangle, kFace);
  const Vector normal = unit_or(difference(sample(kMiddle), n.on.point), face);
  if (dot(normal, normal) > 0) put(n.triangle, n.on.weights, 0.5, normal, gap, kSamples);
}

HeldPoint ProbeOnSurface::held_by(const ContactHit& hit) const noexcept {
  const Vector start = between(sweep_.start.from, sweep_.start.to, share_of(hit));
  const Vector end = between(sweep_.end.from, sweep_.end.to, share_of(hit));
  const Vector plane_move = scaled(share_ * surface_.motion_s(), vector_of(hit.velocity_m_s));
  const double open = hit.gap_m + dot(vector_of(hit.normal), difference(difference(end, start), plane_move));
  const Vector slid = scaled_sum(std::max(0.0, -open), vector_of(hit.normal), end);
  return {start, slid, sweep_.radius_m, vector_of(hit.normal), hit.gap_m};
}

// Of several faces the one that is reached first.
void ProbeOnSurface::add_fold(const ContactHit& first) noexcept {
  const HeldPoint held = held_by(first);
  const Sweep way = {{held.start, held.start}, {held.end, held.end}, sweep_.radius_m};
  FoldTouch best = {};
  uint32_t face = kNone;
  const auto look = [&](uint32_t triangle) {
    const auto touch = touch_in_fold(held, surface_.moving_triangle(triangle, share_), surface_.two_sided());
    if (!touch || grows_from(triangle, touch->on)) return;
    const bool first_of_same = touch->time == best.time && triangle < face;
    if (face == kNone || touch->time < best.time || first_of_same) best = *touch, face = triangle;
  };
  surface_.visit_near(way, share_, (1 + kFoldDeeper) * sweep_.radius_m, filter_.groups,
                      [&](std::span<const uint32_t> triangles) {
                        for (const uint32_t triangle : triangles) look(triangle);
                      });
  if (face == kNone) return;
  put(face, best.on.weights, share_of(first), best.normal, best.gap_m, kFolds + first.name);
}

// A ball is pushed out of one side after the other; so many are asked about that it has to do.
void ProbeOnSurface::add_folds() noexcept {
  if (round_ || !(sweep_.radius_m > 0)) return;
  const uint32_t told = count_;
  for (uint32_t i = 0; i < told; ++i) add_fold(hits_[i]);
}

void ProbeOnSurface::add_outside() noexcept {
  for (const uint32_t end : {kFrom, kTo}) {
    if (!round_ && near(ends_[end])) add(ends_[end], at_start(ends_[end], end), end);
  }
  add_axis();
  add_middle();
  add_folds();
}

// Ends are no further from the surface than the middle and half the axis.
bool ProbeOnSurface::is_near_or_inside() noexcept {
  const double within = samples_[kMiddle].distance_m;
  glance_ = surface_.glance(sample(kMiddle), filter_.groups, within, guess_);
  if (!glance_.outside && !surface_.two_sided()) tell_side(kMiddle);
  const bool found = glance_.triangle != kNone;
  outside_ = closed_ && found && glance_.outside && glance_.at_least_m > half_m_;
  return samples_[kMiddle].inside || (found && glance_.at_least_m - half_m_ <= near_m(speed_m_));
}

// Whether there may be something to tell. All of an axis that goes through nothing is on one side.
bool ProbeOnSurface::look_about() noexcept {
  if (!surface_.may_reach(sample(kMiddle), samples_[kMiddle].distance_m)) {
    outside_ = closed_;
    return false;
  }
  if (from_outside_) {
    find_touches();
    outside_ = !crosses();
    if (outside_) return axis_.triangle != kNone;
  }
  if (!is_near_or_inside()) return false;
  if (!from_outside_) find_touches();
  outside_ = closed_ && glance_.triangle != kNone && glance_.outside && !crosses();
  return true;
}

void ProbeOnSurface::add_ways_out_and_ends() noexcept {
  for (const uint32_t where : {kFrom, kTo, kMiddle}) {
    if (samples_[where].inside) {
      add_way_out(where);
    } else if (where != kMiddle && !round_ && near(ends_[where])) {
      add(ends_[where], at_start(ends_[where], where), where);
    }
  }
}

uint32_t ProbeOnSurface::find(ContactHit (&hits)[kMostContacts]) noexcept {
  hits_ = hits, count_ = 0;
  if (!look_about()) return 0;
  tell_sides_of_ends();
  const bool inside = samples_[kFrom].inside || samples_[kTo].inside || samples_[kMiddle].inside;
  if (inside) {
    add_ways_out_and_ends();
  } else {
    add_outside();
  }
  return count_;
}

}  // namespace sinew::embree

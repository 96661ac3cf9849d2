// touch.cpp  see touch.hpp.
#include "adapters/bullet/touch.hpp"

#include <algorithm>

namespace sinew::bullet {
namespace {

// Gap that is a touch, share of the radius and metres.
constexpr double kTouching = 0.01, kTouching_m = 1e-6;
constexpr int kMoments = 64, kLooks = 24, kHalvings = 6;
// Where ends are nearest to different features, the straight way stalls at one of them: so long it is tried.
constexpr int kStraight = 3;
// An axis lies flat where it rises by no more than this; both ends of it count if they are so far apart.
// Shares of the radius.
constexpr double kFlat = 0.005, kApart = 0.5;
// Of that rise: what is aimed at where its end is guessed, and how little may be left of it.
constexpr double kMeant = 0.98, kLeft = 0.04;

double slope(const Near& near, const Vector& way) { return rods::dot(near.distance.normal, way); }

Near look(const Convex& shape, const Axis& axis, double share) {
  return {share, distance(shape, axis.at(share))};
}

// Where the square of the distance from a round shape's core has no slope, by the slopes of both ends:
// exactly where both are nearest to the same feature of the core, for there it goes straight. What begins in
// the core has none.
double step_to_least(const Convex& shape, const Near& low, const Near& high, const Vector& way) {
  const double from[2] = {low.distance.m + shape.core_m(), high.distance.m + shape.core_m()};
  if (!(std::min(from[0], from[1]) > 0)) return -1;
  const double down = from[0] * slope(low, way), up = from[1] * slope(high, way);
  return (high.share - low.share) * down / (down - up);
}

// Where it leaves the flat part on the way from a point that is in it to an end that is not: where that power
// would which rises to the end as steeply, or else by halving.
Near end_of_flat(const Convex& shape, const Axis& axis, Near in, const Near& end, double most_m) {
  const double way = end.share - in.share, rise_m = end.distance.m - in.distance.m;
  const double flat_m = most_m - in.distance.m;
  const double power = std::max(1.0, slope(end, rods::difference(axis.to, axis.from)) * way / rise_m);
  const Near guess = look(shape, axis, in.share + way * std::pow(kMeant * flat_m / rise_m, 1 / power));
  const double off_m = most_m - guess.distance.m;
  if (off_m >= 0 && off_m <= kLeft * flat_m) return guess;
  double out = end.share;
  for (int k = 0; k < kHalvings; ++k) {
    const Near middle = look(shape, axis, 0.5 * (in.share + out));
    if (middle.distance.m <= most_m) {
      in = middle;
    } else {
      out = middle.share;
    }
  }
  return in;
}

}  // namespace

double Path::closing_m(const Motion& body) const noexcept {
  const double spin = rods::length(body.spin_rad);
  double most = 0;
  for (size_t k = 0; k < 2; ++k) {
    const double way = rods::length(rods::difference(rods::difference(end[k], start[k]), body.move_m));
    const double arm =
        std::max(rods::length(rods::difference(start[k], body.start.at_m)),
                 rods::length(rods::difference(end[k], rods::sum(body.start.at_m, body.move_m))));
    most = std::max(most, way + spin * arm);
  }
  return most;
}

// Distance along the axis is convex: between two points it lies above both tangents, which bound the error,
// and nowhere is it below one point's tangent. Two points' distances differ by no more than how far they are
// apart.
Near nearest(const Convex& shape, const Axis& axis, double exact_m, double beyond_m) noexcept {
  const Vector way = rods::difference(axis.to, axis.from);
  if (beyond_m < kEverywhere) {
    const Near middle = look(shape, axis, 0.5);
    if (middle.distance.m - 0.5 * rods::length(way) > beyond_m) return middle;
  }
  Near low = look(shape, axis, 0);
  if (!(slope(low, way) < 0)) return low;
  Near high = look(shape, axis, 1);
  if (!(slope(high, way) > 0)) return high;
  for (int k = 0; k < kLooks; ++k) {
    const double down = slope(low, way), up = slope(high, way), width = high.share - low.share;
    const double meet = (high.distance.m - low.distance.m - up * width) / (down - up);
    const double bound = low.distance.m + down * meet, least = step_to_least(shape, low, high, way);
    const double step = k < kStraight && k % 2 == 0 && least > 0 ? least : meet;
    const Near now = look(shape, axis, low.share + std::clamp(step, 0.02 * width, 0.98 * width));
    (slope(now, way) < 0 ? low : high) = now;
    const bool is_known = shape.kind != Convex::kOther;  // its slopes may be another's
    if (is_known && std::fabs(slope(now, way)) * width <= exact_m) return now;
    const bool is_far = bound > beyond_m && is_known;
    if (!(std::min(low.distance.m, high.distance.m) > bound + exact_m) || is_far) break;
  }
  return low.distance.m < high.distance.m ? low : high;
}

Touch first_touch(const Convex& shape, const Place& part, const Motion& body, const Path& path,
                  double closing_m, double reach_m) noexcept {
  const double enough = std::max(kTouching * path.radius_m, kTouching_m);
  const auto at = [&](double time, double beyond_m = kEverywhere) {
    return Touch{time, nearest(shape, own_axis(path, time, body.at(time, part)), 0.1 * enough, beyond_m)};
  };
  const double beyond_m = closing_m + reach_m + path.radius_m;
  Touch now = at(0, beyond_m), best = now;
  if (now.near.distance.m > beyond_m) return now;
  for (int k = 1; k < kMoments && now.time < 1; ++k) {
    const double gap = now.near.distance.m - path.radius_m;
    if (!(gap > enough)) break;
    now = at(gap >= closing_m * (1 - now.time) ? 1 : now.time + gap / closing_m);
    if (now.near.distance.m < best.near.distance.m) best = now;
  }
  return best;
}

size_t supports(const Convex& shape, const Axis& axis, const Near& near, double radius_m, double reach_m,
                std::span<Near, 4> out) noexcept {
  const double long_m = axis.length(), most_m = near.distance.m + kFlat * radius_m;
  if (!(long_m > kFlat * radius_m)) return out[0] = near, 1;
  size_t count = 0;
  Near flat[2];
  for (size_t k = 0; k < 2; ++k) {
    const Near end = look(shape, axis, static_cast<double>(k));
    const bool to_the_end = end.distance.m <= most_m;
    flat[k] = to_the_end ? end : end_of_flat(shape, axis, near, end, most_m);
    const bool apart = std::fabs(end.share - near.share) * long_m > kApart * radius_m;
    if (!to_the_end && apart && end.distance.m - radius_m <= reach_m) out[count++] = end;
  }
  if ((flat[1].share - flat[0].share) * long_m > kApart * radius_m) {
    out[count++] = flat[0], out[count++] = flat[1];
  } else {
    out[count++] = near;
  }
  return count;
}

size_t face_supports(const Triangle& t, double side, const Axis& axis, double radius_m, double reach_m,
                     std::span<Near, 2> out) noexcept {
  const Vector twice = area(t), n = rods::scaled(1 / rods::length(twice), twice);
  const Vector way = rods::difference(axis.to, axis.from);
  double low = 0, high = 1;
  for (size_t k = 0; k < 3; ++k) {
    const Vector inwards = rods::cross(n, rods::difference(t.corners[(k + 1) % 3], t.corners[k]));
    const double from = rods::dot(inwards, rods::difference(axis.from, t.corners[k]));
    const double gain = rods::dot(inwards, way);
    if (gain > 0) low = std::max(low, -from / gain);
    if (gain < 0) high = std::min(high, -from / gain);
    if (gain == 0 && from < 0) return 0;
  }
  if (!(low <= high)) return 0;
  const bool apart = (high - low) * axis.length() > kApart * radius_m;
  Near ends[2];
  for (size_t k = 0; k < 2; ++k) {
    const double share = k == 0 ? low : high;
    const double height = side * rods::dot(n, rods::difference(axis.at(share), t.corners[0]));
    ends[k] = {share, {height - t.margin_m, rods::scaled(side, n)}};
  }
  size_t count = 0;
  const bool second_lower = ends[1].distance.m < ends[0].distance.m;
  for (size_t k = 0; k < 2; ++k) {
    if ((apart || (k == 1) == second_lower) && ends[k].distance.m - radius_m <= reach_m)
      out[count++] = ends[k];
  }
  return count;
}

}  // namespace sinew::bullet

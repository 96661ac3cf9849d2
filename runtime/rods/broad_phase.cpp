// broad_phase.cpp  Which segments may touch something at all: balls about them, wide enough for their way.
#include <algorithm>

#include "rods/find_contacts.hpp"

namespace sinew::rods {
namespace {

// Over the ways and radii that a touch is kept for (find_contacts.cpp), and what float leaves of a place and,
// over it, of a way.
constexpr double kWays = 1.25001, kRadii = 1.25, kRounding = 1e-6, kAWay = 1.00001;
// Of the sum of radii, a little more than what counts as a core (hold_strands).
constexpr double kCores = 0.55;

double way_of(const Sweep& s) {
  return std::max(length(difference(s.end.from, s.start.from)), length(difference(s.end.to, s.start.to)));
}

}  // namespace

const Sweep& ContactFinder::sweep(uint32_t strand, uint32_t segment) const {
  if (!to.swept_[local(strand, segment)]) add_sweep(strand, segment);
  return to.sweeps_[local(strand, segment)];
}

// Rows are `width_` apart.
double* ContactFinder::reach(uint32_t strand, uint32_t segment) const {
  const size_t group = strand / batch.width_ - to.range_.first_group, w = batch.width_;
  return to.reaches_ + (group * batch.segment_count_ + segment) * RodCollider::kReachRows * w + strand % w;
}

// Of a group and a segment, lane by lane: rows of fields, and what a lane's strand measures in.
template <size_t kWidth>
struct ContactFinder::Lanes {
  const float *kept, *scratch;
  float length_m[kWidth], radius_m[kWidth];
  double origin_m[3][kWidth];

  float at(uint32_t field, size_t k) const { return kept[field * kWidth + k]; }
  float now(uint32_t field, size_t k) const { return scratch[(field - simd::kRodKeptFields) * kWidth + k]; }
  // How far a segment's end goes from where it is to a move and a turn, at most, in shares of the strand's
  // mean segment: 2 |q - p| bounds how its axis turns.
  float way(uint32_t move_to, uint32_t turn_to, size_t k) const {
    float move = 0, turn = 0;
    for (uint32_t i = 0; i < 3; ++i) move += now(move_to + i, k) * now(move_to + i, k);
    for (uint32_t i = 0; i < 4; ++i) {
      const float by = now(turn_to + i, k) - at(simd::kRodTurn + i, k);
      turn += by * by;
    }
    return std::sqrt(move) + 2 * at(simd::kRodHalfLength, k) * std::sqrt(turn);
  }
  void add_ways(float (&ways)[kWidth]) const {
    for (size_t k = 0; k < kWidth; ++k) {
      float first = 0;
      for (uint32_t i = 0; i < 3; ++i) first += now(simd::kRodMove + i, k) * now(simd::kRodMove + i, k);
      const float free = static_cast<float>(kWays) * way(simd::kRodFreeMove, simd::kRodFreeTurn, k);
      const float to_first = std::sqrt(first);
      ways[k] = free > to_first ? free : to_first;
    }
  }
  void add_half_axes(double* out) const {
    for (size_t k = 0; k < kWidth; ++k) {
      const float x = at(simd::kRodTurn, k), y = at(simd::kRodTurn + 1, k), z = at(simd::kRodTurn + 2, k),
                  w = at(simd::kRodTurn + 3, k);
      const double half = static_cast<double>(length_m[k]) * static_cast<double>(at(simd::kRodHalfLength, k));
      out[k] = half * static_cast<double>(2 * (x * z + y * w));
      out[kWidth + k] = half * static_cast<double>(2 * (y * z - x * w));
      out[2 * kWidth + k] = half * static_cast<double>(1 - 2 * (x * x + y * y));
    }
  }
};

template <size_t kWidth>
void ContactFinder::find_reaches(const Lanes<kWidth>& lanes, double* out) const {
  float ways[kWidth];
  lanes.add_ways(ways);
  for (size_t k = 0; k < kWidth; ++k) {
    const double l = static_cast<double>(lanes.length_m[k]);
    double far = 0;
    for (uint32_t i = 0; i < 3; ++i) {
      const double place = static_cast<double>(lanes.at(simd::kRodPlace + i, k));
      out[i * kWidth + k] = lanes.origin_m[i][k] + l * place;
      far += std::fabs(place);
    }
    const double margin = l * kRounding * (far + 1), radius = static_cast<double>(lanes.radius_m[k]);
    out[RodCollider::kReachMargin * kWidth + k] = margin;
    out[RodCollider::kReachHalf * kWidth + k] =
        l * static_cast<double>(lanes.at(simd::kRodHalfLength, k)) + margin;
    out[RodCollider::kReachTouch * kWidth + k] = l * static_cast<double>(ways[k]) + kRadii * radius;
    out[RodCollider::kReachRadius * kWidth + k] = radius;
    out[RodCollider::kReachClear * kWidth + k] = HUGE_VAL;
  }
  lanes.add_half_axes(out + RodCollider::kReachAxis * kWidth);
}

// And boxes about the group's strands.
template <size_t kWidth>
void ContactFinder::find_reaches(uint32_t group) const {
  Lanes<kWidth> lanes;
  const uint32_t first = group * batch.width_;
  const auto strand = [&](size_t k) {
    return std::min<uint32_t>(first + static_cast<uint32_t>(k), batch.strand_count_ - 1);
  };
  for (size_t k = 0; k < kWidth; ++k) {
    const RodBatch::Units& units = batch.units_[strand(k)];
    lanes.length_m[k] = units.length_m;
    for (size_t i = 0; i < 3; ++i) lanes.origin_m[i][k] = units.origin_m[i];
  }
  double low[3][kWidth], high[3][kWidth];
  std::fill_n(&low[0][0], 3 * kWidth, HUGE_VAL), std::fill_n(&high[0][0], 3 * kWidth, -HUGE_VAL);
  double* out = to.reaches_ + size_t{group - to.range_.first_group} * batch.segment_count_ *
                                  RodCollider::kReachRows * kWidth;
  for (uint32_t i = 0; i < batch.segment_count_; ++i, out += RodCollider::kReachRows * kWidth) {
    lanes.kept = &batch.at(first, i, 0),
    lanes.scratch = to.scratch_row(batch, first, i, simd::kRodKeptFields);
    for (size_t k = 0; k < kWidth; ++k) {
      lanes.radius_m[k] = batch.radii_m_[size_t{strand(k)} * batch.segment_count_ + i];
    }
    find_reaches(lanes, out);
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t k = 0; k < kWidth; ++k) {
        const double at = out[axis * kWidth + k];
        const double touch =
            out[RodCollider::kReachHalf * kWidth + k] + out[RodCollider::kReachTouch * kWidth + k];
        low[axis][k] = at - touch < low[axis][k] ? at - touch : low[axis][k];
        high[axis][k] = at + touch > high[axis][k] ? at + touch : high[axis][k];
      }
    }
  }
  for (uint32_t s = first; s < std::min(first + batch.width_, batch.strand_count_); ++s) {
    const size_t k = s - first;
    to.strand_boxes_[s - first_strand()] = {{low[0][k], low[1][k], low[2][k]},
                                            {high[0][k], high[1][k], high[2][k]}};
  }
}

void ContactFinder::find_reaches() const {
  for (uint32_t g = 0; g < to.range_.groups; ++g) {
    const uint32_t group = to.range_.first_group + g;
    batch.width_ == 16 ? find_reaches<16>(group) : find_reaches<4>(group);
  }
  std::fill_n(to.swept_, size_t{end_strand() - first_strand()} * batch.segment_count_, uint8_t{0});
}

// Of all its segments together; the box is none where the plane turns, for its way then grows without end.
bool ContactFinder::near(uint32_t strand, const Plane& plane) const {
  const SweptBox& box = to.strand_boxes_[strand - first_strand()];
  const Vector n = vector_of(plane.normal), linear = vector_of(plane.motion.linear_m_s);
  const Vector spin = vector_of(plane.motion.angular_rad_s);
  if (dot(spin, spin) > 0) return true;
  double height = 0;
  for (size_t k = 0; k < 3; ++k) height += n[k] * ((n[k] > 0 ? box.low : box.high)[k] - plane.point_m[k]);
  return !(height > 2 * kWays * dt_s * length(linear) * length(n));
}

bool ContactFinder::near(uint32_t strand, uint32_t segment, const Plane& plane) const {
  const double* at = reach(strand, segment);
  const size_t w = batch.width_;
  const Vector arm = {at[0] - plane.point_m[0], at[w] - plane.point_m[1], at[2 * w] - plane.point_m[2]};
  const Vector n = vector_of(plane.normal), spin = vector_of(plane.motion.angular_rad_s);
  const double touch = at[RodCollider::kReachHalf * w] + at[RodCollider::kReachTouch * w];
  const double height = dot(arm, n) / length(n);
  const double turns = length(spin) > 0 ? length(spin) * (length(arm) + touch) : 0;
  const double way = dt_s * (length(vector_of(plane.motion.linear_m_s)) + turns);
  return height < touch + 2 * kWays * way;
}

// Of a group's segments, at the step's start: from their axes to the obstacle's, at least; exact to a point.
// Distance from an axis is convex along another one: no less than along the tangent in the middle.
// What is left of that before an axis is in the obstacle's core stays with all obstacles before.
template <size_t kWidth>
void ContactFinder::find_distances(uint32_t group, const Sweep& obstacle) const {
  const Vector from = obstacle.start.from, u = difference(obstacle.start.to, from);
  const double uu = dot(u, u), per_square = uu > 0 ? 1 / uu : 0, way = way_of(obstacle);
  double* rows = reach(group * batch.width_, 0);
  for (uint32_t i = 0; i < batch.segment_count_; ++i, rows += RodCollider::kReachRows * kWidth) {
    const double *middle = rows, *axis = rows + RodCollider::kReachAxis * kWidth,
                 *half = rows + RodCollider::kReachHalf * kWidth;
    const double *margin = rows + RodCollider::kReachMargin * kWidth,
                 *radius = rows + RodCollider::kReachRadius * kWidth;
    double *distance = rows + RodCollider::kReachDistance * kWidth,
           *clear = rows + RodCollider::kReachClear * kWidth;
    if (uu > 0) {
      for (size_t k = 0; k < kWidth; ++k) {
        const double x = middle[k] - from[0], y = middle[kWidth + k] - from[1],
                     z = middle[2 * kWidth + k] - from[2];
        const double along = per_square * (x * u[0] + y * u[1] + z * u[2]);
        const double above = along > 0 ? along : 0, share = above < 1 ? above : 1;
        const double ax = x - share * u[0], ay = y - share * u[1], az = z - share * u[2];
        const double away = std::sqrt(ax * ax + ay * ay + az * az);
        const double slope = std::fabs(ax * axis[k] + ay * axis[kWidth + k] + az * axis[2 * kWidth + k]);
        const double nearer = slope < half[k] * away ? slope / away : half[k];
        distance[k] = away - nearer - margin[k];
      }
    } else {
      for (size_t k = 0; k < kWidth; ++k) {
        const double hx = axis[k], hy = axis[kWidth + k], hz = axis[2 * kWidth + k];
        const double x = middle[k] - from[0], y = middle[kWidth + k] - from[1],
                     z = middle[2 * kWidth + k] - from[2];
        const double along = -(x * hx + y * hy + z * hz) / (hx * hx + hy * hy + hz * hz);
        const double above = along > -1 ? along : -1, share = above < 1 ? above : 1;
        const double ax = x + share * hx, ay = y + share * hy, az = z + share * hz;
        distance[k] = std::sqrt(ax * ax + ay * ay + az * az) - margin[k];
      }
    }
    for (size_t k = 0; k < kWidth; ++k) {
      const double left = distance[k] - way - kCores * (radius[k] + obstacle.radius_m);
      clear[k] = left < clear[k] ? left : clear[k];
    }
  }
}

void ContactFinder::find_distances(uint32_t group, const Sweep& obstacle) const {
  batch.width_ == 16 ? find_distances<16>(group, obstacle) : find_distances<4>(group, obstacle);
}

double ContactFinder::reach_of(const Sweep& obstacle) const {
  return obstacle.radius_m + kWays * way_of(obstacle);
}

// By find_distances to an obstacle of this reach.
bool ContactFinder::near(uint32_t strand, uint32_t segment, double reach_m) const {
  const double* at = reach(strand, segment);
  const size_t w = batch.width_;
  return at[RodCollider::kReachDistance * w] < at[RodCollider::kReachTouch * w] + reach_m;
}

// Ways to the iterate, into kReachDistance. Returns whether one of the group may lead into a core.
template <size_t kWidth>
bool ContactFinder::find_ways(uint32_t group) const {
  Lanes<kWidth> lanes;
  const uint32_t first = group * batch.width_, count = std::min(batch.width_, batch.strand_count_ - first);
  double length_m[kWidth] = {};
  for (size_t k = 0; k < count; ++k) {
    length_m[k] = static_cast<double>(batch.units_[first + k].length_m);
  }
  double* rows = reach(first, 0);
  bool any = false;
  for (uint32_t i = 0; i < batch.segment_count_; ++i, rows += RodCollider::kReachRows * kWidth) {
    lanes.kept = &batch.at(first, i, 0);
    lanes.scratch = to.scratch_row(batch, first, i, simd::kRodKeptFields);
    double *ways = rows + RodCollider::kReachDistance * kWidth,
           *clear = rows + RodCollider::kReachClear * kWidth;
    for (size_t k = 0; k < kWidth; ++k) {
      ways[k] = kAWay * length_m[k] * static_cast<double>(lanes.way(simd::kRodMove, simd::kRodNow, k));
    }
    for (size_t k = 0; k < count; ++k) any |= !(ways[k] < clear[k]);
  }
  return any;
}

bool ContactFinder::find_ways(uint32_t group) const {
  return batch.width_ == 16 ? find_ways<16>(group) : find_ways<4>(group);
}

// By find_ways.
bool ContactFinder::may_enter(uint32_t strand, uint32_t segment) const {
  const double* at = reach(strand, segment);
  const size_t w = batch.width_;
  return free(strand, segment) && !(at[RodCollider::kReachDistance * w] < at[RodCollider::kReachClear * w]);
}

}  // namespace sinew::rods

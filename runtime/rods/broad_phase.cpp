// broad_phase.cpp  Which segments may touch something at all: balls about them, wide enough for their way.
#include <algorithm>

#include "rods/find_contacts.hpp"

namespace sinew::rods {
namespace {

// Over the ways and radii that a touch is kept for (find_contacts.cpp), and what float leaves of a place.
constexpr double kWays = 1.25001, kRadii = 1.25, kRounding = 1e-6;
// Of the sum of radii, a little more than what counts as a core (hold_strands).
constexpr double kCores = 0.55;

// How far a segment's end goes from where it is to a move and a turn, at most: 2 |q - p| bounds how its axis
// turns.
double way_of(const double (&move)[3], const double (&turn)[4], double half) {
  const double m = move[0] * move[0] + move[1] * move[1] + move[2] * move[2];
  const double q = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3];
  return std::sqrt(m) + 2 * half * std::sqrt(q);
}

double way_of(const Sweep& s) {
  return std::max(length(difference(s.end.from, s.start.from)), length(difference(s.end.to, s.start.to)));
}

}  // namespace

const Sweep& ContactFinder::sweep(uint32_t strand, uint32_t segment) const {
  if (!to.swept_[local(strand, segment)]) add_sweep(strand, segment);
  return to.sweeps_[local(strand, segment)];
}

// Rows are `width_` apart.
const double* ContactFinder::reach(uint32_t strand, uint32_t segment) const {
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
  // Shares of the strand's mean segment, as way_of.
  void add_ways(float (&ways)[kWidth]) const {
    for (size_t k = 0; k < kWidth; ++k) {
      float move = 0, turn = 0, first = 0;
      for (uint32_t i = 0; i < 3; ++i) {
        move += now(simd::kRodFreeMove + i, k) * now(simd::kRodFreeMove + i, k);
        first += now(simd::kRodMove + i, k) * now(simd::kRodMove + i, k);
      }
      for (uint32_t i = 0; i < 4; ++i) {
        const float by = now(simd::kRodFreeTurn + i, k) - at(simd::kRodTurn + i, k);
        turn += by * by;
      }
      const float half = at(simd::kRodHalfLength, k);
      const float way = static_cast<float>(kWays) * (std::sqrt(move) + 2 * half * std::sqrt(turn));
      const float to_first = std::sqrt(first);
      ways[k] = way > to_first ? way : to_first;
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
    const double half = l * (static_cast<double>(lanes.at(simd::kRodHalfLength, k)) + kRounding * far);
    out[RodCollider::kReachHalf * kWidth + k] = half;
    out[RodCollider::kReachTouch * kWidth + k] =
        half + l * static_cast<double>(ways[k]) + kRadii * static_cast<double>(lanes.radius_m[k]);
  }
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
        const double at = out[axis * kWidth + k], touch = out[RodCollider::kReachTouch * kWidth + k];
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
  const double touch = at[RodCollider::kReachTouch * w], height = dot(arm, n) / length(n);
  const double turns = length(spin) > 0 ? length(spin) * (length(arm) + touch) : 0;
  const double way = dt_s * (length(vector_of(plane.motion.linear_m_s)) + turns);
  return height < touch + 2 * kWays * way;
}

// From the middle to the obstacle's axis where the step begins.
double ContactFinder::nearest_m(uint32_t strand, uint32_t segment, const Sweep& obstacle) const {
  const double* at = reach(strand, segment);
  const Vector middle = {at[0], at[batch.width_], at[2 * batch.width_]};
  const Axis& axis = obstacle.start;
  return length(difference(middle, between(axis.from, axis.to, nearest(axis, middle))));
}

bool ContactFinder::near(uint32_t strand, uint32_t segment, const Sweep& obstacle) const {
  const double touch = reach(strand, segment)[RodCollider::kReachTouch * batch.width_];
  return nearest_m(strand, segment, obstacle) < touch + obstacle.radius_m + kWays * way_of(obstacle);
}

// Whether the iterate's way may lead into it.
bool ContactFinder::may_reach(uint32_t strand, uint32_t segment, const Sweep& core) const {
  double move[3], turn[4];
  for (uint32_t k = 0; k < 3; ++k) {
    move[k] = static_cast<double>(*to.scratch_row(batch, strand, segment, simd::kRodMove + k));
  }
  for (uint32_t k = 0; k < 4; ++k) {
    turn[k] = static_cast<double>(*to.scratch_row(batch, strand, segment, simd::kRodNow + k)) -
              static_cast<double>(batch.at(strand, segment, simd::kRodTurn + k));
  }
  const double half = static_cast<double>(batch.at(strand, segment, simd::kRodHalfLength));
  const double way = way_of(move, turn, half) * static_cast<double>(batch.units_[strand].length_m);
  const double radius = static_cast<double>(batch.radii_m_[size_t{strand} * batch.segment_count_ + segment]);
  const double begin = reach(strand, segment)[RodCollider::kReachHalf * batch.width_];
  return nearest_m(strand, segment, core) < begin + way + way_of(core) + kCores * (radius + core.radius_m);
}

}  // namespace sinew::rods

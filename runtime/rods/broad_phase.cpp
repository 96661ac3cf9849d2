// broad_phase.cpp  Which segments may touch something at all: balls about them, wide enough for their way.
#include <algorithm>

#include "rods/find_contacts.hpp"

namespace sinew::rods {
namespace {

// Over the ways and radii that a touch is kept for (find_contacts.cpp), and what float leaves of a place.
constexpr double kWays = 1.25, kRadii = 1.25, kRounding = 1e-6;
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

void ContactFinder::find_reaches(uint32_t group, uint32_t segment) const {
  const size_t w = batch.width_;
  const uint32_t first = group * batch.width_, count = std::min(batch.width_, batch.strand_count_ - first);
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t strand = first + k;
    const RodBatch::Units& units = batch.units_[strand];
    const double l = static_cast<double>(units.length_m);
    const float* kept = &batch.at(strand, segment, 0);
    const float* scratch = to.scratch_row(batch, strand, segment, simd::kRodKeptFields);
    const auto at = [&](uint32_t field) { return static_cast<double>(kept[field * w]); };
    const auto now = [&](uint32_t field) {
      return static_cast<double>(scratch[(field - simd::kRodKeptFields) * w]);
    };
    double* out = to.reaches_ +
                  (size_t{group - to.range_.first_group} * batch.segment_count_ + segment) *
                      RodCollider::kReachRows * w +
                  k;
    const double half = at(simd::kRodHalfLength);
    double move[3], turn[4], first_move = 0, far = 0;
    for (uint32_t i = 0; i < 3; ++i) {
      const double place = at(simd::kRodPlace + i), begin = now(simd::kRodMove + i);
      out[i * w] = units.origin_m[i] + l * place;
      move[i] = now(simd::kRodFreeMove + i);
      first_move += begin * begin;
      far += std::fabs(place);
    }
    for (uint32_t i = 0; i < 4; ++i) turn[i] = now(simd::kRodFreeTurn + i) - at(simd::kRodTurn + i);
    const double radius =
        static_cast<double>(batch.radii_m_[size_t{strand} * batch.segment_count_ + segment]);
    const double way = std::max(kWays * way_of(move, turn, half), std::sqrt(first_move));
    out[RodCollider::kReachHalf * w] = l * (half + kRounding * far);
    out[RodCollider::kReachTouch * w] = l * (half + kRounding * far + way) + kRadii * radius;
  }
}

// And boxes about strands.
void ContactFinder::find_reaches() const {
  for (uint32_t g = 0; g < to.range_.groups; ++g) {
    for (uint32_t i = 0; i < batch.segment_count_; ++i) find_reaches(to.range_.first_group + g, i);
  }
  std::fill_n(to.swept_, size_t{end_strand() - first_strand()} * batch.segment_count_, uint8_t{0});
  const size_t w = batch.width_;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    SweptBox& box = to.strand_boxes_[s - first_strand()];
    box.low.fill(HUGE_VAL), box.high.fill(-HUGE_VAL);
    for (uint32_t i = 0; i < batch.segment_count_; ++i) {
      const double* at = reach(s, i);
      for (size_t k = 0; k < 3; ++k) {
        box.low[k] = std::min(box.low[k], at[k * w] - at[RodCollider::kReachTouch * w]);
        box.high[k] = std::max(box.high[k], at[k * w] + at[RodCollider::kReachTouch * w]);
      }
    }
  }
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

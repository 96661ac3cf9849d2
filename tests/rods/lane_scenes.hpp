// lane_scenes.hpp  One group of strands with any numbers in its lanes, for the kernels that find contacts.
#pragma once
#include <random>
#include <vector>

#include "core/aligned_block.hpp"
#include "kernels/kernels.hpp"
#include "kernels/rods/rod_job.hpp"
#include "rods/contacts/find/sweep.hpp"
#include "tests/simd/test_data.hpp"

namespace sinew::test {

// Segments of a tenth to a whole of a metre, about a centimetre thick, that lie anyhow within two metres of
// `far_m` in each coordinate and go up to `way_m`.
class LaneScene {
 public:
  LaneScene(uint32_t width, uint32_t segments, double far_m, float way_m, uint32_t seed)
      : width_(width), segments_(segments), random_(seed), memory_(bytes()) {
    lay_out();
    for (uint32_t k = 0; k < width; ++k) {
      length_m_[k] = any(0.1f, 1);
      for (size_t i = 0; i < 3; ++i) origin_m_[i * width + k] = far_m + static_cast<double>(any(-1, 1));
      for (uint32_t i = 0; i < segments; ++i) fill(i, k, way_m);
    }
  }

  simd::RodReachJob job(uint32_t strands) {
    return {records_, scratch_, radii_m_, length_m_, origin_m_, reaches_, boxes_, segments_, strands};
  }
  uint32_t width() const { return width_; }
  uint32_t segments() const { return segments_; }
  double radius_m(uint32_t i, uint32_t k) const { return static_cast<double>(radii_m_[i * width_ + k]); }
  double length_m(uint32_t k) const { return static_cast<double>(length_m_[k]); }
  float& at(uint32_t i, uint32_t field, uint32_t k) {
    return field < simd::kRodKeptFields
               ? records_[(i * simd::kRodKeptFields + field) * width_ + k]
               : scratch_[(i * simd::kRodScratchRows + field - simd::kRodKeptFields) * width_ + k];
  }
  float reach(uint32_t i, uint32_t row, uint32_t k) const {
    return reaches_[(i * simd::kReachRows + row) * width_ + k];
  }

  // As ContactFinder::add_sweep makes it.
  rods::Sweep sweep(uint32_t i, uint32_t k) {
    const rods::Vector here = place(i, k), move = three(i, simd::kRodFreeMove, k);
    return {axis(i, k, here, simd::kRodTurn),
            axis(i, k, rods::sum(here, rods::scaled(length_m(k), move)), simd::kRodFreeTurn), radius_m(i, k)};
  }
  // To where the iterate is.
  rods::Sweep taken(uint32_t i, uint32_t k) {
    const rods::Vector here = place(i, k), move = three(i, simd::kRodMove, k);
    return {axis(i, k, here, simd::kRodTurn),
            axis(i, k, rods::sum(here, rods::scaled(length_m(k), move)), simd::kRodNow), radius_m(i, k)};
  }

  float any(float low, float high) { return uniform(random_, low, high); }
  rods::Vector any_place(double about_m, float spread_m) {
    const auto one = [&] { return about_m + static_cast<double>(any(-spread_m, spread_m)); };
    return {one(), one(), one()};
  }

 private:
  size_t bytes() {
    lay_out();
    return used_;
  }
  void lay_out() {
    core::Arena arena(memory_.data());
    records_ = arena.take<float>(size_t{segments_} * simd::kRodKeptFields * width_);
    scratch_ = arena.take<float>(size_t{segments_} * simd::kRodScratchRows * width_);
    radii_m_ = arena.take<float>(size_t{segments_} * width_);
    length_m_ = arena.take<float>(width_);
    origin_m_ = arena.take<double>(size_t{3} * width_);
    reaches_ = arena.take<float>(size_t{segments_} * simd::kReachRows * width_);
    boxes_ = arena.take<float>(size_t{simd::kBoxRows} * width_);
    used_ = arena.used_bytes();
  }
  void fill(uint32_t i, uint32_t k, float way_m) {
    at(i, simd::kRodFree, k) = 1;
    at(i, simd::kRodHalfLength, k) = any(0.4f, 0.6f);
    radii_m_[i * width_ + k] = any(0.005f, 0.015f);
    for (uint32_t n = 0; n < 3; ++n) {
      at(i, simd::kRodPlace + n, k) = any(-1, 1) / length_m_[k];
      at(i, simd::kRodPlaceLow + n, k) = any(-3e-8f, 3e-8f);
      at(i, simd::kRodFreeMove + n, k) = any(-way_m, way_m) / length_m_[k];
      at(i, simd::kRodMove + n, k) = any(-way_m, way_m) / length_m_[k];
    }
    const float turned = way_m / length_m_[k];
    turn(i, simd::kRodTurn, k, 1, {0, 0, 0, 0});
    for (const uint32_t field : {simd::kRodFreeTurn, simd::kRodNow}) {
      turn(i, field, k, std::min(turned, 1.0f), quaternion(i, simd::kRodTurn, k));
    }
  }
  rods::Turn quaternion(uint32_t i, uint32_t field, uint32_t k) {
    rods::Turn q;
    for (uint32_t n = 0; n < 4; ++n) q[n] = static_cast<double>(at(i, field + n, k));
    return q;
  }
  void turn(uint32_t i, uint32_t field, uint32_t k, float by, rods::Turn from) {
    for (double& x : from) x += static_cast<double>(any(-by, by));
    const rods::Turn q = rods::normalised(from);
    for (uint32_t n = 0; n < 4; ++n) at(i, field + n, k) = static_cast<float>(q[n]);
  }
  rods::Vector three(uint32_t i, uint32_t field, uint32_t k) {
    const auto one = [&](uint32_t n) { return static_cast<double>(at(i, field + n, k)); };
    return {one(0), one(1), one(2)};
  }
  rods::Vector place(uint32_t i, uint32_t k) {
    rods::Vector out;
    const rods::Vector high = three(i, simd::kRodPlace, k), low = three(i, simd::kRodPlaceLow, k);
    for (size_t n = 0; n < 3; ++n) out[n] = origin_m_[n * width_ + k] + (high[n] + low[n]) * length_m(k);
    return out;
  }
  rods::Axis axis(uint32_t i, uint32_t k, const rods::Vector& middle, uint32_t field) {
    const rods::Turn q = quaternion(i, field, k);
    const rods::Vector along = {2 * (q[0] * q[2] + q[1] * q[3]), 2 * (q[1] * q[2] - q[0] * q[3]),
                                1 - 2 * (q[0] * q[0] + q[1] * q[1])};
    const double half = static_cast<double>(at(i, simd::kRodHalfLength, k)) * length_m(k);
    return {rods::scaled_sum(-half, along, middle), rods::scaled_sum(half, along, middle)};
  }

  uint32_t width_, segments_;
  std::mt19937 random_;
  size_t used_ = 0;
  float *records_ = nullptr, *scratch_ = nullptr, *radii_m_ = nullptr, *length_m_ = nullptr,
        *reaches_ = nullptr, *boxes_ = nullptr;
  double* origin_m_ = nullptr;
  core::AlignedBlock memory_;
};

inline const simd::RodTouchCalls& touch_calls(const simd::Kernels& kernels, uint32_t width) {
  return width == 16 ? kernels.rod_touches->wide : kernels.rod_touches->narrow;
}

inline simd::RodRound round_of(const rods::Sweep& sweep) {
  simd::RodRound round = {};
  const auto way = [](const rods::Vector& from, const rods::Vector& to) {
    return rods::length(rods::difference(to, from));
  };
  for (size_t k = 0; k < 3; ++k) {
    round.start_m[0][k] = sweep.start.from[k], round.start_m[1][k] = sweep.start.to[k];
    round.end_m[0][k] = sweep.end.from[k], round.end_m[1][k] = sweep.end.to[k];
    round.middle_m[k] = 0.5 * (sweep.end.from[k] + sweep.end.to[k]);
  }
  round.radius_m = sweep.radius_m;
  round.way_m = std::max(way(sweep.start.from, sweep.end.from), way(sweep.start.to, sweep.end.to));
  round.dt_s = 1.0 / 60;
  return round;
}

}  // namespace sinew::test

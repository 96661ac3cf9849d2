// modal_base.cpp  Frame terms, modal recurrences and warping; sums over modes are simd/rows-inl.hpp.
#include "tissue/modal_base.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "simd/kernels.hpp"

namespace sinew::tissue {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

Matrix3f rotation_of(const NodePose& pose) { return Eigen::Map<const Rows33>(pose.rotation); }
Vector3f vector_at(const float* v, uint32_t i) { return Eigen::Map<const Vector3f>(v + size_t{3} * i); }

// (1 - cos a) / a^2 and (a - sin a) / a^3 as series in s = a^2 <= 4: what is left out is below 1e-9.
struct TurnSeries {
  float c, d;
};

TurnSeries turn_series(float s) {
  constexpr int kTerms = 8;
  // 1 / (2k + 2)! and 1 / (2k + 3)!, signs alternating.
  constexpr float kC[kTerms] = {5.00000000e-1f, -4.16666667e-2f, 1.38888889e-3f,  -2.48015873e-5f,
                                2.75573192e-7f, -2.08767570e-9f, 1.14707456e-11f, -4.77947733e-14f};
  constexpr float kD[kTerms] = {1.66666667e-1f, -8.33333333e-3f,  1.98412698e-4f,  -2.75573192e-6f,
                                2.50521084e-8f, -1.60590438e-10f, 7.64716373e-13f, -2.81145725e-15f};
  TurnSeries series{kC[kTerms - 1], kD[kTerms - 1]};
  for (int k = kTerms - 2; k >= 0; --k) {
    series.c = series.c * s + kC[k];
    series.d = series.d * s + kD[k];
  }
  return series;
}

// By compare, so that NaN stays NaN.
void hold_turn(float theta[3]) {
  const float squared = theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2];
  if (!(squared > kLargestTurn_rad * kLargestTurn_rad)) return;
  const float scale = kLargestTurn_rad / std::sqrt(squared);
  for (int k = 0; k < 3; ++k) theta[k] *= scale;
}

void clear_padding(const ModalBase& base, float* x) {
  std::fill(x + size_t{3} * base.node_count, x + base.padded, 0.0f);
}

}  // namespace

ModalBase modal_base(const pack::PackView& pack, size_t region) noexcept {
  const pack::RegionModesRecord& record = pack.region_modes[region];
  const size_t plane = size_t{record.mode_count} * record.padded;
  const float* matrices = pack.mode_matrices.data() + record.matrices;
  return {.modes = pack.modes.subspan(record.first_mode, record.mode_count),
          .node_count = pack.regions[region].node_count,
          .padded = record.padded,
          .shape = matrices,
          .turn = matrices + plane,
          .force = matrices + 2 * plane,
          .project = matrices + 3 * plane,
          .rest = matrices + 4 * plane,
          .rest_a1 = record.rest_a1,
          .rest_a2 = record.rest_a2,
          .rest_gain = record.rest_gain};
}

// R_t^T (2 (R_{t-1} - R_t) u_{t-1} - (R_{t-2} - R_t) u_{t-2}) / h^2: differences of frames first, so that
// nothing is left of rounding where they are equal.
void frame_term(const NodePose* const pose[3], const float* u, const float* u_before, float tick_s,
                uint32_t count, float* phi) noexcept {
  const float rate2 = 1 / (tick_s * tick_s);
  for (uint32_t i = 0; i < count; ++i) {
    const Matrix3f now = rotation_of(pose[0][i]);
    const Vector3f swept = 2 * ((rotation_of(pose[1][i]) - now) * vector_at(u, i)) -
                           (rotation_of(pose[2][i]) - now) * vector_at(u_before, i);
    Eigen::Map<Vector3f>(phi + size_t{3} * i) = rate2 * (now.transpose() * swept);
  }
}

// Rodrigues: exp([t]x)^T v = v - (sin a / a) t x v + C t x (t x v), sin a / a = 1 - s D.
void turn_back(const float theta[3], const float felt[3], float out[3]) noexcept {
  const Vector3f t = vector_at(theta, 0), v = vector_at(felt, 0), turned = t.cross(v);
  const float s = t.squaredNorm();
  const TurnSeries series = turn_series(s);
  Eigen::Map<Vector3f>{out} = v - (1 - s * series.d) * turned + series.c * t.cross(turned);
}

// W v = v + C t x v + D t x (t x v).
void warp(const float theta[3], const float l[3], float out[3]) noexcept {
  const Vector3f t = vector_at(theta, 0), v = vector_at(l, 0), turned = t.cross(v);
  const TurnSeries series = turn_series(t.squaredNorm());
  Eigen::Map<Vector3f>{out} = v + series.c * turned + series.d * t.cross(turned);
}

void modal_step(const ModalBase& base, const float* felt, const ModalState& state, float* e,
                const ModalAnswer& answer) noexcept {
  const simd::Kernels& kernels = simd::kernels();
  const auto modes = static_cast<uint32_t>(base.modes.size());
  const uint32_t floats = 3 * base.node_count;
  for (uint32_t i = 0; i < floats; i += 3) turn_back(state.theta + i, felt + i, e + i);
  clear_padding(base, e);
  kernels.dot_rows(base.force, modes, base.padded, e, answer.q);
  for (uint32_t k = 0; k < modes; ++k) {
    const pack::ModeRecord& mode = base.modes[k];
    answer.q[k] = mode.a1 * state.q[k] + mode.a2 * state.q_before[k] + mode.gain * answer.q[k];
  }
  kernels.add_rows(base.shape, modes, base.padded, answer.q, answer.l);
  kernels.dot_rows(base.rest, floats, base.padded, e, answer.r);
  for (uint32_t i = 0; i < floats; ++i) {
    answer.r[i] = base.rest_a1 * state.r[i] + base.rest_a2 * state.r_before[i] + base.rest_gain * answer.r[i];
    answer.l[i] += answer.r[i];
  }
}

void modal_project(const ModalBase& base, const float* l, float* q) noexcept {
  float add[pack::kMaxModes];
  const auto modes = static_cast<uint32_t>(base.modes.size());
  simd::kernels().dot_rows(base.project, modes, base.padded, l, add);
  for (uint32_t k = 0; k < modes; ++k) q[k] += add[k];
}

void modal_turn(const ModalBase& base, const float* q, float* turned, float* theta) noexcept {
  simd::kernels().add_rows(base.turn, static_cast<uint32_t>(base.modes.size()), base.padded, q, turned);
  for (uint32_t i = 0; i < base.node_count; ++i) {
    std::copy_n(turned + 3 * i, 3, theta + 3 * i);
    hold_turn(theta + 3 * i);
  }
}

}  // namespace sinew::tissue

// modal_base.cpp  Frame terms and modal recurrences; sums over modes are kernels/surface/rows-inl.hpp, turns
// kernels/surface/turn-inl.hpp.
#include "tissue/modes/modal_base.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/kernels.hpp"

namespace sinew::tissue {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

Matrix3f rotation_of(const NodePose& pose) { return Eigen::Map<const Rows33>(pose.rotation); }
Vector3f vector_at(const float* v, uint32_t i) { return Eigen::Map<const Vector3f>(v + size_t{3} * i); }

// By compare, so that NaN stays NaN.
void hold_turn(float theta[3]) {
  const float squared = theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2];
  if (!(squared > kLargestTurn_rad * kLargestTurn_rad)) return;
  const float scale = kLargestTurn_rad / std::sqrt(squared);
  for (int k = 0; k < 3; ++k) theta[k] *= scale;
}

}  // namespace

ModalBase modal_base(const pack::PackView& pack, size_t region) noexcept {
  const pack::RegionModesRecord& record = pack.region_modes[region];
  const uint32_t nodes = pack.regions[region].node_count;
  const auto padded_modes = static_cast<uint32_t>(pack::round_up_16(record.mode_count));
  const float* shape = pack.mode_matrices.data() + record.matrices;
  const float* turn = shape + size_t{record.mode_count} * record.padded;
  const float* response = turn + size_t{record.mode_count} * record.padded;
  return {.modes = pack.modes.subspan(record.first_mode, record.mode_count),
          .node_count = nodes,
          .padded = record.padded,
          .padded_modes = padded_modes,
          .shape = shape,
          .turn = turn,
          .response = response,
          .project = response + size_t{3} * nodes * (record.padded + padded_modes),
          .rest_a1 = record.rest_a1,
          .rest_a2 = record.rest_a2,
          .rest_gain = record.rest_gain};
}

// R_t^T (2 (R_{t-1} - R_t) u_{t-1} - (R_{t-2} - R_t) u_{t-2}) / h^2: differences of frames first, so that
// nothing is left of rounding where they are equal.
void frame_term(const NodePose* const pose[3], const float* u, const float* u_before, float tick_s,
                uint32_t count, float* phi, float x) noexcept {
  const float rate2 = 1 / (tick_s * tick_s);
  for (uint32_t i = 0; i < count; ++i) {
    const Matrix3f now = rotation_of(pose[0][i]);
    const Vector3f swept = (1 + x) * ((rotation_of(pose[1][i]) - now) * vector_at(u, i)) -
                           x * ((rotation_of(pose[2][i]) - now) * vector_at(u_before, i));
    Eigen::Map<Vector3f>(phi + size_t{3} * i) = rate2 * (now.transpose() * swept);
  }
}

void turn_back(const float* theta, const float* v, uint32_t count, float* out) noexcept {
  simd::kernels().turn_back({.turns = theta, .turn_stride = 3, .in = v, .out = out, .count = count});
}

void warp(const float* theta, const float* l, uint32_t count, float* out) noexcept {
  simd::kernels().warp({.turns = theta, .turn_stride = 3, .in = l, .out = out, .count = count});
}

void modal_hear(const ModalBase& base, const float* felt, const float* theta, float* e,
                float* heard) noexcept {
  turn_back(theta, felt, base.node_count, e);
  simd::kernels().add_rows(base.response, 3 * base.node_count, base.padded + base.padded_modes, e, heard);
}

void modal_answer(const ModalBase& base, const float* heard, const ModalState& state,
                  const ModalAnswer& answer) noexcept {
  const auto modes = static_cast<uint32_t>(base.modes.size());
  const uint32_t floats = 3 * base.node_count;
  const float *rest = heard, *force = heard + base.padded;
  for (uint32_t k = 0; k < modes; ++k) {
    const pack::ModeRecord& mode = base.modes[k];
    answer.q[k] = mode.a1 * state.q[k] + mode.a2 * state.q_before[k] + mode.gain * force[k];
  }
  simd::kernels().add_rows(base.shape, modes, base.padded, answer.q, answer.l);
  for (uint32_t i = 0; i < floats; ++i) {
    answer.r[i] = base.rest_a1 * state.r[i] + base.rest_a2 * state.r_before[i] + base.rest_gain * rest[i];
    answer.l[i] += answer.r[i];
  }
}

void modal_project(const ModalBase& base, const float* l, float* q) noexcept {
  alignas(64) float add[pack::kMaxModes];
  simd::kernels().add_rows(base.project, 3 * base.node_count, base.padded_modes, l, add);
  for (size_t k = 0; k < base.modes.size(); ++k) q[k] += add[k];
}

void modal_turn(const ModalBase& base, const float* q, float* scratch, float* theta) noexcept {
  simd::kernels().add_rows(base.turn, static_cast<uint32_t>(base.modes.size()), base.padded, q, scratch);
  std::copy_n(scratch, size_t{3} * base.node_count, theta);
  for (uint32_t i = 0; i < base.node_count; ++i) hold_turn(theta + size_t{3} * i);
}

}  // namespace sinew::tissue

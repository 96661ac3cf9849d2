// inputs.cpp  Each input's numbers in columns, a block of nodes at a time; kernels/surface/hold-inl.hpp
// brings them to scale, holds them inside what training saw and makes rows of them.
#include "tissue/network/inputs.hpp"

#include <algorithm>

#include "kernels/kernels.hpp"
#include "tissue/frames/node_drive.hpp"

namespace sinew::tissue {
namespace {

using pack::InputKind;
using simd::kBlock;

// Every kind once, padded.
constexpr size_t kMostInputs = 64;

// One number of each node of a block.
using Column = float[kBlock];

struct Vectors {
  Column x, y, z;
};

// Nodes first..first + count of a region; lanes behind them repeat the last.
struct Block {
  uint32_t first, count;
  size_t node(uint32_t lane) const { return first + std::min(lane, count - 1); }
};

void take(const Block& block, const float* rows, size_t stride, Column& out) {
  for (uint32_t i = 0; i < kBlock; ++i) out[i] = rows[stride * block.node(i)];
}

Vectors vectors_of(const Block& block, const float* rows, size_t stride) {
  Vectors v;
  take(block, rows, stride, v.x);
  take(block, rows + 1, stride, v.y);
  take(block, rows + 2, stride, v.z);
  return v;
}

// operation(number of a, number of b), coordinate by coordinate.
template <class Operation>
Vectors combined(const Vectors& a, const Vectors& b, const Operation& operation) {
  Vectors out;
  for (uint32_t i = 0; i < kBlock; ++i) out.x[i] = operation(a.x[i], b.x[i]);
  for (uint32_t i = 0; i < kBlock; ++i) out.y[i] = operation(a.y[i], b.y[i]);
  for (uint32_t i = 0; i < kBlock; ++i) out.z[i] = operation(a.z[i], b.z[i]);
  return out;
}

Vectors scaled(float scale, const Vectors& v) {
  return combined(v, v, [=](float a, float) { return a * scale; });
}

Vectors difference(float scale, const Vectors& v, const Vectors& less) {
  return combined(v, less, [=](float a, float b) { return (a - b) * scale; });
}

Vectors cross(const Vectors& a, const Vectors& b) {
  Vectors out;
  for (uint32_t i = 0; i < kBlock; ++i) out.x[i] = a.y[i] * b.z[i] - a.z[i] * b.y[i];
  for (uint32_t i = 0; i < kBlock; ++i) out.y[i] = a.z[i] * b.x[i] - a.x[i] * b.z[i];
  for (uint32_t i = 0; i < kBlock; ++i) out.z[i] = a.x[i] * b.y[i] - a.y[i] * b.x[i];
  return out;
}

// What moves a block's nodes and how they moved, in the units of pack/format.hpp, before the inputs' scales.
struct Motion {
  Motion(const NodeSources& s, float unit_m, const Block& block)
      : felt(scaled(1 / (s.first_rad_per_s * s.first_rad_per_s * unit_m), vectors_of(block, s.felt, 3))),
        l(vectors_of(block, s.l, 3)),
        step(difference(1 / unit_m, vectors_of(block, s.l_hat, 3), l)),
        velocity(difference(1 / unit_m, l, vectors_of(block, s.l_before, 3))),
        theta(vectors_of(block, s.theta, 3)),
        angular_velocity(vectors_of(block, s.drive + 6, kNodeDriveWidth)),
        bend(vectors_of(block, s.drive + 12, kNodeDriveWidth)) {
    l = scaled(1 / unit_m, l);
  }
  Vectors felt, l, step, velocity, theta, angular_velocity, bend;
};

Vectors rest_positions(const NodeSources& sources, const Block& block) {
  Vectors v;
  const float *center = sources.region->center_m, radius = sources.region->radius_m;
  for (uint32_t i = 0; i < kBlock; ++i) {
    const float* place = sources.nodes[block.node(i)].position_m;
    v.x[i] = (place[0] - center[0]) / radius;
    v.y[i] = (place[1] - center[1]) / radius;
    v.z[i] = (place[2] - center[2]) / radius;
  }
  return v;
}

constexpr size_t kNodeStride = sizeof(pack::NodeRecord) / sizeof(float);

// Of inputs that are vectors.
Vectors vector_values(InputKind kind, const NodeSources& sources, const Motion& motion, const Block& block) {
  switch (kind) {
    case InputKind::kRestPosition:
      return rest_positions(sources, block);
    case InputKind::kRestNormal:
      return vectors_of(block, sources.nodes->normal, kNodeStride);
    case InputKind::kGravityChange:
      return vectors_of(block, sources.drive + 3, kNodeDriveWidth);
    case InputKind::kAngularVelocity:
      return motion.angular_velocity;
    case InputKind::kAngularAcceleration:
      return vectors_of(block, sources.drive + 9, kNodeDriveWidth);
    case InputKind::kDisplacement:
      return motion.l;
    case InputKind::kVelocity:
      return motion.velocity;
    case InputKind::kFeltStep:
      return motion.felt;
    case InputKind::kBaseStep:
      return motion.step;
    case InputKind::kTurn:
      return motion.theta;
    case InputKind::kBend:
      return motion.bend;
    case InputKind::kBentForce:
      return cross(motion.bend, motion.felt);
    case InputKind::kBentStep:
      return cross(motion.bend, motion.step);
    case InputKind::kBentDisplacement:
      return cross(motion.bend, motion.l);
    case InputKind::kTurnedForce:
      return cross(motion.theta, motion.felt);
    case InputKind::kTurnedStep:
      return cross(motion.theta, motion.step);
    case InputKind::kTurnedVelocity:
      return cross(motion.theta, motion.velocity);
    case InputKind::kSpunStep:
      return cross(motion.angular_velocity, motion.step);
    case InputKind::kSpunVelocity:
      return cross(motion.angular_velocity, motion.velocity);
    case InputKind::kStiffness:
    case InputKind::kFrequency:
      break;
  }
  return {};
}

uint32_t width_of(InputKind kind) {
  return kind == InputKind::kStiffness || kind == InputKind::kFrequency ? 1 : 3;
}

// Before scales.
void put_values(InputKind kind, const NodeSources& sources, const Motion& motion, const Block& block,
                Column* to) {
  if (kind == InputKind::kStiffness) {
    return take(block, &sources.nodes->stiffness, kNodeStride, *to);
  }
  if (kind == InputKind::kFrequency) {
    std::ranges::fill(*to, sources.first_rad_per_s * sources.tick_s);
    return;
  }
  const Vectors values = vector_values(kind, sources, motion, block);
  std::ranges::copy(values.x, to[0]);
  std::ranges::copy(values.y, to[1]);
  std::ranges::copy(values.z, to[2]);
}

}  // namespace

size_t input_stride(const Network& network) noexcept {
  return simd::pad_to_block(network.record->input_width);
}

float length_unit_m(const Network& network, const pack::RegionRecord& region) noexcept {
  return network.record->length_unit * region.radius_m;
}

uint32_t assemble_inputs(const Network& network, const NodeSources& sources, float* z) noexcept {
  alignas(64) float scale[kMostInputs] = {}, bound[kMostInputs] = {};
  alignas(64) Column columns[kMostInputs] = {};
  size_t width = 0;
  for (const pack::InputRecord& input : network.inputs) {
    const uint32_t columns_of = width_of(input.kind);
    std::fill_n(scale + width, columns_of, input.scale);
    std::fill_n(bound + width, columns_of, input.envelope);
    width += columns_of;
  }
  const size_t stride = input_stride(network);
  const float unit_m = length_unit_m(network, *sources.region);
  uint32_t held = 0;
  for (uint32_t first = 0; first < sources.region->node_count; first += kBlock) {
    const Block block{first, std::min(kBlock, sources.region->node_count - first)};
    const Motion motion(sources, unit_m, block);
    Column* column = columns;
    for (const pack::InputRecord& input : network.inputs) {
      put_values(input.kind, sources, motion, block, column);
      column += width_of(input.kind);
    }
    held += simd::kernels().hold_columns({columns[0], scale, bound, z + stride * first, stride, block.count});
  }
  return held;
}

float trust_in(const Network& network, const NodeSources& sources, uint32_t clamped) noexcept {
  constexpr float kClampedShare = 0.05f, kFasterShare = 0.25f;
  float numbers = 0, trust = 1;
  for (const pack::InputRecord& input : network.inputs) {
    const auto width = static_cast<float>(width_of(input.kind) * sources.region->node_count);
    if (input.kind != InputKind::kFrequency) {
      numbers += width;
      continue;
    }
    const float faster = sources.first_rad_per_s * sources.tick_s * input.scale / input.envelope - 1;
    if (faster > 0) clamped -= std::min(clamped, sources.region->node_count);  // a number a node, told apart
    trust = std::clamp(1 - faster / kFasterShare, 0.0f, 1.0f);
  }
  const float outside = static_cast<float>(clamped) / (kClampedShare * std::max(numbers, 1.0f));
  return trust * std::max(0.0f, 1 - outside);
}

}  // namespace sinew::tissue

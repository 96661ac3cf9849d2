// inputs.cpp  Copies each input's numbers to its place, scaled and held inside what training saw.
#include "tissue/inputs.hpp"

#include <algorithm>
#include <cmath>

#include "simd/kernels.hpp"
#include "tissue/node_drive.hpp"

namespace sinew::tissue {
namespace {

using pack::InputKind;

// What one input is for one node, before its scale.
struct Value {
  float v[3];
  uint32_t width;
};

Value from_floats(const float* v) { return {{v[0], v[1], v[2]}, 3}; }

Value rest_position(const NodeSources& sources, uint32_t node) {
  const float* place = sources.nodes[node].position_m;
  const float* center = sources.region->center_m;
  const float radius = sources.region->radius_m;
  return {{(place[0] - center[0]) / radius, (place[1] - center[1]) / radius, (place[2] - center[2]) / radius},
          3};
}

Value scaled_by(float scale, const float* v) { return {{v[0] * scale, v[1] * scale, v[2] * scale}, 3}; }

Value difference(float scale, const float* v, const float* less) {
  return {{(v[0] - less[0]) * scale, (v[1] - less[1]) * scale, (v[2] - less[2]) * scale}, 3};
}

Value cross(const float* a, const Value& b) {
  return {{a[1] * b.v[2] - a[2] * b.v[1], a[2] * b.v[0] - a[0] * b.v[2], a[0] * b.v[1] - a[1] * b.v[0]}, 3};
}

// The vectors that are crossed with each other, in length units (a tick) where they are lengths.
struct Motion {
  Value felt_step, base_step, displacement, velocity;
};

Motion motion_of(const NodeSources& sources, size_t at, float unit_m) {
  const float w1 = sources.first_rad_per_s;
  return {scaled_by(1 / (w1 * w1 * unit_m), sources.felt + at),
          difference(1 / unit_m, sources.l_hat + at, sources.l + at), scaled_by(1 / unit_m, sources.l + at),
          difference(1 / unit_m, sources.l + at, sources.l_before + at)};
}

Value value_of(InputKind kind, const NodeSources& sources, uint32_t node, const Motion& motion) {
  const float* drive = sources.drive + size_t{node} * kNodeDriveWidth;
  const float *angular_velocity = drive + 6, *bend = drive + 12;
  const float* theta = sources.theta + size_t{node} * 3;
  switch (kind) {
    case InputKind::kRestPosition:
      return rest_position(sources, node);
    case InputKind::kRestNormal:
      return from_floats(sources.nodes[node].normal);
    case InputKind::kStiffness:
      return {{sources.nodes[node].stiffness}, 1};
    case InputKind::kGravityChange:
      return from_floats(drive + 3);
    case InputKind::kAngularVelocity:
      return from_floats(angular_velocity);
    case InputKind::kAngularAcceleration:
      return from_floats(drive + 9);
    case InputKind::kDisplacement:
      return motion.displacement;
    case InputKind::kVelocity:
      return motion.velocity;
    case InputKind::kFeltStep:
      return motion.felt_step;
    case InputKind::kBaseStep:
      return motion.base_step;
    case InputKind::kTurn:
      return from_floats(theta);
    case InputKind::kFrequency:
      return {{sources.first_rad_per_s * sources.tick_s}, 1};
    case InputKind::kBend:
      return from_floats(bend);
    case InputKind::kBentForce:
      return cross(bend, motion.felt_step);
    case InputKind::kBentStep:
      return cross(bend, motion.base_step);
    case InputKind::kBentDisplacement:
      return cross(bend, motion.displacement);
    case InputKind::kTurnedForce:
      return cross(theta, motion.felt_step);
    case InputKind::kTurnedStep:
      return cross(theta, motion.base_step);
    case InputKind::kTurnedVelocity:
      return cross(theta, motion.velocity);
    case InputKind::kSpunStep:
      return cross(angular_velocity, motion.base_step);
    case InputKind::kSpunVelocity:
      return cross(angular_velocity, motion.velocity);
  }
  return {};
}

// Writes value x scale; returns how many were clamped.
uint32_t put_scaled(const Value& value, const pack::InputRecord& input, float* out) {
  uint32_t clamps = 0;
  for (uint32_t k = 0; k < value.width; ++k) {
    const float scaled = value.v[k] * input.scale;
    const bool finite = std::isfinite(scaled);
    out[k] = finite ? std::clamp(scaled, -input.envelope, input.envelope) : 0;
    clamps += !finite || out[k] != scaled;
  }
  return clamps;
}

uint32_t fill_row(const Network& network, const NodeSources& sources, uint32_t node, float* row) {
  const Motion motion = motion_of(sources, size_t{node} * 3, length_unit_m(network, *sources.region));
  uint32_t clamps = 0;
  float* out = row;
  for (const pack::InputRecord& input : network.inputs) {
    const Value value = value_of(input.kind, sources, node, motion);
    clamps += put_scaled(value, input, out);
    out += value.width;
  }
  std::fill(out, row + input_stride(network), 0.0f);
  return clamps;
}

}  // namespace

size_t input_stride(const Network& network) noexcept {
  return simd::pad_to_block(network.record->input_width);
}

float length_unit_m(const Network& network, const pack::RegionRecord& region) noexcept {
  return network.record->length_unit * region.radius_m;
}

uint32_t assemble_inputs(const Network& network, const NodeSources& sources, float* z) noexcept {
  uint32_t clamps = 0;
  for (uint32_t node = 0; node < sources.region->node_count; ++node) {
    clamps += fill_row(network, sources, node, z + node * input_stride(network));
  }
  return clamps;
}

}  // namespace sinew::tissue

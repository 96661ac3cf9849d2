// inputs.cpp  Copies each input's numbers to its place, scaled and held inside what training saw.
#include "tissue/inputs.hpp"

#include <algorithm>
#include <cmath>

#include "simd/kernels.hpp"
#include "tissue/drive.hpp"

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

Value in_length_units(const float* metres, const float* less, float unit_m) {
  Value value{{}, 3};
  for (int axis = 0; axis < 3; ++axis) value.v[axis] = (metres[axis] - (less ? less[axis] : 0)) / unit_m;
  return value;
}

Value value_of(InputKind kind, const NodeSources& sources, uint32_t node, float unit_m) {
  const float* drive = sources.drive + size_t{node} * kDriveWidth;
  const float* u = sources.displacement + size_t{node} * 3;
  switch (kind) {
    case InputKind::kRestPosition:
      return rest_position(sources, node);
    case InputKind::kRestNormal:
      return from_floats(sources.nodes[node].normal);
    case InputKind::kStiffness:
      return {{sources.nodes[node].stiffness}, 1};
    case InputKind::kLinearAcceleration:
      return from_floats(drive);
    case InputKind::kEulerAcceleration:
      return from_floats(drive + 3);
    case InputKind::kCentrifugalAcceleration:
      return from_floats(drive + 6);
    case InputKind::kArticulationAcceleration:
      return from_floats(drive + 9);
    case InputKind::kAngularAcceleration:
      return from_floats(drive + 12);
    case InputKind::kAngularVelocity:
      return from_floats(drive + 15);
    case InputKind::kGravityChange:
      return from_floats(drive + 18);
    case InputKind::kDisplacement:
      return in_length_units(u, nullptr, unit_m);
    case InputKind::kVelocity:
      return in_length_units(u, sources.displacement_before + size_t{node} * 3, unit_m);
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
  uint32_t clamps = 0;
  float* out = row;
  for (const pack::InputRecord& input : network.inputs) {
    const Value value = value_of(input.kind, sources, node, network.record->length_unit_m);
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

uint32_t assemble_inputs(const Network& network, const NodeSources& sources, float* z) noexcept {
  uint32_t clamps = 0;
  for (uint32_t node = 0; node < sources.region->node_count; ++node) {
    clamps += fill_row(network, sources, node, z + node * input_stride(network));
  }
  return clamps;
}

}  // namespace sinew::tissue

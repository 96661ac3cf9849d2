// inputs.cpp  Copies each input's numbers to its columns, then scales all and holds them inside what training
// saw (simd/hold-inl.hpp).
#include "tissue/inputs.hpp"

#include <algorithm>
#include <array>

#include "simd/kernels.hpp"
#include "tissue/node_drive.hpp"

namespace sinew::tissue {
namespace {

using pack::InputKind;

// Every kind once, padded.
constexpr size_t kMostInputs = 64;

using Vector = std::array<float, 3>;
using Number = std::array<float, 1>;

Vector vector_at(const float* v) { return {v[0], v[1], v[2]}; }

Vector scaled(float scale, const float* v) { return {v[0] * scale, v[1] * scale, v[2] * scale}; }

Vector difference(float scale, const float* v, const float* less) {
  return {(v[0] - less[0]) * scale, (v[1] - less[1]) * scale, (v[2] - less[2]) * scale};
}

Vector cross(const float* a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector rest_position(const NodeSources& sources, const float* place) {
  const float* center = sources.region->center_m;
  const float radius = sources.region->radius_m;
  return {(place[0] - center[0]) / radius, (place[1] - center[1]) / radius, (place[2] - center[2]) / radius};
}

// One input's columns in the rows of all nodes.
struct Columns {
  float* first;
  size_t stride;
  uint32_t nodes;
};

// value(node), an array as wide as the input. Returns that width.
template <class Value>
uint32_t put(const Columns& columns, const Value& value) {
  for (uint32_t node = 0; node < columns.nodes; ++node)
    std::ranges::copy(value(node), columns.first + node * columns.stride);
  return static_cast<uint32_t>(value(0).size());
}

// Before scales. Returns the input's width.
uint32_t put_values(InputKind kind, const NodeSources& sources, float unit_m, const Columns& to) {
  const float w1 = sources.first_rad_per_s, per_unit = 1 / unit_m, per_felt = 1 / (w1 * w1 * unit_m);
  const auto drive = [&](uint32_t node, size_t at) {
    return sources.drive + size_t{node} * kNodeDriveWidth + at;
  };
  const auto angular_velocity = [&](uint32_t node) { return drive(node, 6); };
  const auto bend = [&](uint32_t node) { return drive(node, 12); };
  const auto theta = [&](uint32_t node) { return sources.theta + size_t{3} * node; };
  const auto l = [&](uint32_t node) { return scaled(per_unit, sources.l + size_t{3} * node); };
  const auto felt = [&](uint32_t node) { return scaled(per_felt, sources.felt + size_t{3} * node); };
  const auto step = [&](uint32_t node) {
    const size_t at = size_t{3} * node;
    return difference(per_unit, sources.l_hat + at, sources.l + at);
  };
  const auto velocity = [&](uint32_t node) {
    const size_t at = size_t{3} * node;
    return difference(per_unit, sources.l + at, sources.l_before + at);
  };
  switch (kind) {
    case InputKind::kRestPosition:
      return put(to, [&](uint32_t n) { return rest_position(sources, sources.nodes[n].position_m); });
    case InputKind::kRestNormal:
      return put(to, [&](uint32_t n) { return vector_at(sources.nodes[n].normal); });
    case InputKind::kStiffness:
      return put(to, [&](uint32_t n) { return Number{sources.nodes[n].stiffness}; });
    case InputKind::kGravityChange:
      return put(to, [&](uint32_t n) { return vector_at(drive(n, 3)); });
    case InputKind::kAngularVelocity:
      return put(to, [&](uint32_t n) { return vector_at(angular_velocity(n)); });
    case InputKind::kAngularAcceleration:
      return put(to, [&](uint32_t n) { return vector_at(drive(n, 9)); });
    case InputKind::kDisplacement:
      return put(to, l);
    case InputKind::kVelocity:
      return put(to, velocity);
    case InputKind::kFeltStep:
      return put(to, felt);
    case InputKind::kBaseStep:
      return put(to, step);
    case InputKind::kTurn:
      return put(to, [&](uint32_t n) { return vector_at(theta(n)); });
    case InputKind::kFrequency:
      return put(to, [&](uint32_t) { return Number{w1 * sources.tick_s}; });
    case InputKind::kBend:
      return put(to, [&](uint32_t n) { return vector_at(bend(n)); });
    case InputKind::kBentForce:
      return put(to, [&](uint32_t n) { return cross(bend(n), felt(n)); });
    case InputKind::kBentStep:
      return put(to, [&](uint32_t n) { return cross(bend(n), step(n)); });
    case InputKind::kBentDisplacement:
      return put(to, [&](uint32_t n) { return cross(bend(n), l(n)); });
    case InputKind::kTurnedForce:
      return put(to, [&](uint32_t n) { return cross(theta(n), felt(n)); });
    case InputKind::kTurnedStep:
      return put(to, [&](uint32_t n) { return cross(theta(n), step(n)); });
    case InputKind::kTurnedVelocity:
      return put(to, [&](uint32_t n) { return cross(theta(n), velocity(n)); });
    case InputKind::kSpunStep:
      return put(to, [&](uint32_t n) { return cross(angular_velocity(n), step(n)); });
    case InputKind::kSpunVelocity:
      return put(to, [&](uint32_t n) { return cross(angular_velocity(n), velocity(n)); });
  }
  return 0;
}

}  // namespace

size_t input_stride(const Network& network) noexcept {
  return simd::pad_to_block(network.record->input_width);
}

float length_unit_m(const Network& network, const pack::RegionRecord& region) noexcept {
  return network.record->length_unit * region.radius_m;
}

uint32_t assemble_inputs(const Network& network, const NodeSources& sources, float* z) noexcept {
  alignas(64) float scale[kMostInputs] = {}, envelope[kMostInputs] = {};
  const size_t stride = input_stride(network);
  const uint32_t nodes = sources.region->node_count;
  const float unit_m = length_unit_m(network, *sources.region);
  size_t column = 0;
  for (const pack::InputRecord& input : network.inputs) {
    const uint32_t width = put_values(input.kind, sources, unit_m, {z + column, stride, nodes});
    std::fill_n(scale + column, width, input.scale);
    std::fill_n(envelope + column, width, input.envelope);
    column += width;
  }
  for (uint32_t node = 0; node < nodes; ++node)
    std::fill(z + node * stride + column, z + (node + 1) * stride, 0.0f);
  return simd::kernels().hold_rows(z, nodes, stride, scale, envelope);
}

}  // namespace sinew::tissue

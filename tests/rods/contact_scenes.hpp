// contact_scenes.hpp  Rods among obstacles, and what the tests measure on them.
#pragma once
#include <catch2/catch.hpp>

#include "rods/contacts/collider.hpp"
#include "tests/rods/rod_scenes.hpp"

namespace sinew::test {

inline constexpr float kFrame_s = 1.0f / 60;

inline rods::RodCollider collider_of(const RodBatch& batch, const rods::ColliderSettings& settings = {}) {
  rods::RodCollider collider;
  REQUIRE(rods::RodCollider::create(batch, settings, &collider).ok());
  return collider;
}

inline RodReport step(RodBatch& batch, rods::RodCollider& collider, float dt_s = kFrame_s) {
  RodReport report;
  REQUIRE(batch.step(dt_s, &collider, &report).ok());
  return report;
}

// A rod of a metre, a centimetre thick, along x, its axis at a height; free.
inline Segments lying_rod(double height_m, uint32_t segments = 10, float young_pa = 1e6f) {
  Segments rod = straight_rod(
      {.segments = segments, .young_pa = young_pa, .length_m = 1, .radius_m = 0.01f, .held = false});
  for (SegmentDef& s : rod) s.position_m[1] = height_m;
  return rod;
}

// The same along z, its middle at x.
inline Segments crossing_rod(double x_m, double height_m, uint32_t segments = 10, float young_pa = 1e6f) {
  Segments rod = lying_rod(height_m, segments, young_pa);
  for (SegmentDef& s : rod) {
    s.position_m[2] = s.position_m[0] - 0.5;
    s.position_m[0] = x_m;
    for (float& q : s.orientation) q = 0;
    s.orientation[3] = 1;
  }
  return rod;
}

inline void throw_rod(RodBatch& batch, uint32_t strand, float x, float y, float z) {
  for (uint32_t i = 0; i < batch.segment_count(); ++i) {
    REQUIRE(batch.set_velocity(strand, i, {{x, y, z}, {0, 0, 0}}).ok());
  }
}

inline rods::Vector mean_velocity(const RodBatch& batch, uint32_t strand) {
  rods::Vector out = {};
  for (uint32_t i = 0; i < batch.segment_count(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      out[k] += static_cast<double>(batch.velocity(strand, i).linear_m_s[k]) / batch.segment_count();
    }
  }
  return out;
}

}  // namespace sinew::test

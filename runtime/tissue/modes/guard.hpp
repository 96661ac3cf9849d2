// guard.hpp  What stands between the tissue's numbers and the character, after a step.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "pack/format.hpp"
#include "tissue/network/network_weights.hpp"

namespace sinew::tissue {

bool all_finite(const float* values, size_t count) noexcept;

// NaN in any state reaches y of the last layer in the step it arises in, so y is what is looked at; with an
// unbounded cell state (state_clamp infinite) every c is looked at as well.
bool network_is_finite(const Network& network, uint32_t node_count, const float* state) noexcept;

// Up to this share of its limit a displacement is left alone; from there it approaches the limit smoothly.
inline constexpr float kFreeShare = 0.6f;

// What a region's displacement is shown with so that the largest stays below the limit: 1 up to kFreeShare of
// it. largest_m not finite: 1 for NaN.
float limit_share(float largest_m, float limit_m) noexcept;

// What a region's swing is held with: 1 up to its limit, and so that it stays about within 1.67 of it.
// Further out it would swing on unseen, long after what threw it has ended. Scaled in all that goes on from a
// tick, it is as if it had swung that much less before: the swing gains no energy, and under a load that
// lasts beyond the limit it is damped.
float swing_share(float largest_m, float limit_m) noexcept;

// Of [nodes][3]; lengths by hypot, for the square of a wild displacement may overflow.
float largest_displacement_m(const float* l, uint32_t nodes) noexcept;

// Scales a region's displacement to what is shown of it.
void show(float share, uint32_t nodes, float* u) noexcept;

// To what may be shown of it. What swings is left alone up to the limit: scaled with it, it would lose energy
// that the tissue has.
void hold_within(float limit_m, uint32_t nodes, float* u) noexcept;

// l ([node_count][3], metres) of y and back; what is beyond a region's limit is remembered as it is shown.
void read_output(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                 const float* state, float* l) noexcept;
void write_output(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                  const float* l, float* state) noexcept;

// What a network's step adds to the region's y ([nodes][3]) so that it starts from this l.
void carry_to(const Network& network, const pack::RegionRecord& region, uint32_t node_count, const float* l,
              const float* state, float* carry) noexcept;

// The state of a network that stands at l with no memory: y of the last layer is that, everything else zero.
void rebase_state(const Network& network, std::span<const pack::RegionRecord> regions, uint32_t node_count,
                  const float* l, float* state) noexcept;

}  // namespace sinew::tissue

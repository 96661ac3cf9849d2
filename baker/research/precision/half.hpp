// half.hpp  A half (IEEE binary16) as the float it is.
#pragma once
#include <bit>
#include <cstdint>

namespace sinew::baker {

using Half = uint16_t;

// Exact; infinity and NaN stay what they are.
constexpr float half_to_float(Half half) noexcept {
  const uint32_t magnitude = (half & 0x7fffu) << 13, sign = (half & 0x8000u) << 16;
  if (magnitude >= 31u << 23) return std::bit_cast<float>(sign | (magnitude + (224u << 23)));
  const float tiny = std::bit_cast<float>(magnitude + (113u << 23)) - 0x1p-14f;
  const float value = magnitude < 1u << 23 ? tiny : std::bit_cast<float>(magnitude + (112u << 23));
  return sign != 0 ? -value : value;
}

}  // namespace sinew::baker

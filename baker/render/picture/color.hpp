// color.hpp  sRGB, tone mapping, and the ramp that shows a scalar as colour.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace sinew::render {

using Rgb = Eigen::Vector3f;              // linear light, Rec. 709 primaries
using RgbBytes = std::array<uint8_t, 3>;  // sRGB

Rgb linear_from_srgb(RgbBytes srgb);
RgbBytes srgb_from_linear(const Rgb& linear);  // clamps to 0..1

// Khronos PBR Neutral: leaves base colours below 0.8 as they are and rolls highlights off to white.
Rgb tone_map(const Rgb& linear);

// Pale at 0, crimson at 1 (clamped), even steps of OKLab lightness: more is darker, in print and to any eye.
Rgb ramp(float t);

}  // namespace sinew::render

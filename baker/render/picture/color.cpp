// color.cpp  see color.hpp.
#include "baker/render/picture/color.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::render {
namespace {

float decode(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }
float encode(float l) { return l <= 0.0031308f ? l * 12.92f : 1.055f * std::pow(l, 1 / 2.4f) - 0.055f; }

// B. Ottosson, A perceptual color space for image processing, 2020.
Rgb linear_from_oklab(float lightness, float a, float b) {
  const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
  const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
  const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
  const Eigen::Vector3f lms(l * l * l, m * m * m, s * s * s);
  return {lms.dot(Eigen::Vector3f(4.0767416621f, -3.3077115913f, 0.2309699292f)),
          lms.dot(Eigen::Vector3f(-1.2684380046f, 2.6097574011f, -0.3413193965f)),
          lms.dot(Eigen::Vector3f(-0.0041960863f, -0.7034186147f, 1.7076147010f))};
}

}  // namespace

Rgb linear_from_srgb(RgbBytes srgb) {
  const auto channel = [](uint8_t byte) { return decode(static_cast<float>(byte) / 255); };
  return {channel(srgb[0]), channel(srgb[1]), channel(srgb[2])};
}

RgbBytes srgb_from_linear(const Rgb& linear) {
  const auto channel = [](float l) {
    return static_cast<uint8_t>(std::lround(255 * encode(std::clamp(l, 0.0f, 1.0f))));
  };
  return {channel(linear.x()), channel(linear.y()), channel(linear.z())};
}

Rgb tone_map(const Rgb& linear) {
  constexpr float kStart = 0.8f - 0.04f, kDesaturation = 0.15f;
  const float least = linear.minCoeff();
  const float offset = least < 0.08f ? least - 6.25f * least * least : 0.04f;
  const Rgb color = linear.array() - offset;
  const float peak = color.maxCoeff();
  if (peak < kStart) return color;
  const float room = 1 - kStart;
  const float new_peak = 1 - room * room / (peak + room - kStart);
  const float white = 1 - 1 / (kDesaturation * (peak - new_peak) + 1);
  return (1 - white) * (new_peak / peak) * color + Rgb::Constant(white * new_peak);
}

Rgb ramp(float t) {
  const float u = std::clamp(t, 0.0f, 1.0f);
  const float lightness = 0.95f - 0.60f * u;
  const float chroma = 0.015f + 0.40f * u - 0.27f * u * u;
  const float hue = (95 - 80 * u - 10 * u * (1 - u)) * 0.017453293f;
  return linear_from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue)).cwiseMax(0).cwiseMin(1);
}

}  // namespace sinew::render

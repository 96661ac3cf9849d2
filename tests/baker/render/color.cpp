// color.cpp  sRGB, the tone curve and the ramp.
#include <catch2/catch.hpp>

#include "baker/render/picture/color.hpp"

using namespace sinew::render;

namespace {

// Rec. 709 luminance; rises with perceived lightness.
float luminance(const Rgb& c) { return 0.2126f * c.x() + 0.7152f * c.y() + 0.0722f * c.z(); }

}  // namespace

TEST_CASE("colors_outside_the_displayable_range_are_clamped") {
  CHECK(srgb_from_linear({-1, 0, 2}) == RgbBytes{0, 0, 255});
  CHECK(ramp(-3) == ramp(0));
  CHECK(ramp(7) == ramp(1));
}

TEST_CASE("srgb_bytes_survive_the_way_to_linear_light_and_back") {
  for (int value = 0; value < 256; ++value) {
    const auto byte = static_cast<uint8_t>(value);
    CHECK(srgb_from_linear(linear_from_srgb({byte, byte, byte})) == RgbBytes{byte, byte, byte});
  }
  // Half of the code values is a fifth of the light.
  CHECK(linear_from_srgb({128, 128, 128}).x() == Approx(0.2158).epsilon(1e-3));
}

TEST_CASE("tone_curve_keeps_middle_tones_and_never_reaches_beyond_white") {
  const Rgb grey = Rgb::Constant(0.4f);
  CHECK((tone_map(grey) - (grey - Rgb::Constant(0.04f))).norm() < 1e-6f);
  float last = 0;
  for (float light = 0.01f; light < 100; light *= 1.1f) {
    const float shown = tone_map(Rgb::Constant(light)).maxCoeff();
    CHECK(shown >= last);
    CHECK(shown <= 1);
    last = shown;
  }
}

TEST_CASE("ramp_goes_from_pale_to_dark_in_even_steps") {
  CHECK(luminance(ramp(0)) > 0.8f);
  CHECK(luminance(ramp(1)) < 0.08f);
  CHECK(ramp(1).x() > 4 * ramp(1).y());  // ends in red
  for (int i = 0; i < 100; ++i) {
    CHECK(luminance(ramp(static_cast<float>(i) / 100)) > luminance(ramp(static_cast<float>(i + 1) / 100)));
  }
}

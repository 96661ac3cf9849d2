// stroke_font.hpp  Printable ASCII as pen strokes, so that pictures can be labelled on a machine without
// fonts.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

namespace sinew::render {

// Units: the baseline is y = 0, capitals are 7 high, small letters 5.
inline constexpr float kCapHeight = 7;

struct Glyph {
  std::vector<std::vector<Eigen::Vector2f>> strokes;  // polylines; a single point is a dot
  float advance = 0;
};

// Anything that is not printable ASCII is a box.
const Glyph& glyph(char character);

}  // namespace sinew::render

// lines.hpp  Smooth-edged lines in pictures.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "baker/render/picture/image.hpp"

namespace sinew::render {

inline float distance_to_segment(const Eigen::Vector2f& p, const Eigen::Vector2f& a,
                                 const Eigen::Vector2f& b) {
  const Eigen::Vector2f side = b - a;
  const float length2 = side.squaredNorm();
  const float t = length2 > 0 ? std::clamp((p - a).dot(side) / length2, 0.0f, 1.0f) : 0.0f;
  return (p - a - t * side).norm();
}

// Through the points, in pixels from the top left corner. Clips at the edges.
void draw_polyline(Image& image, std::span<const Eigen::Vector2f> points, float width_px, RgbBytes color);

}  // namespace sinew::render

// text.cpp  see text.hpp.
#include "baker/render/picture/text.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/render/picture/lines.hpp"
#include "baker/render/picture/stroke_font.hpp"

namespace sinew::render {
namespace {

struct Pen {
  Image& image;
  float scale, radius_px;
  RgbBytes color;

  Eigen::Vector2f pixel(const Eigen::Vector2f& unit, float left, float baseline) const {
    return {left + scale * unit.x(), baseline - scale * unit.y()};
  }

  // Distances to the whole glyph first: overlapping strokes must not darken each other's edges.
  void draw(const Glyph& glyph, float left, float baseline) const {
    Eigen::AlignedBox2f box;
    for (const auto& stroke : glyph.strokes) {
      for (const Eigen::Vector2f& p : stroke) box.extend(pixel(p, left, baseline));
    }
    if (box.isEmpty()) return;
    const float pad = radius_px + 1;
    for (int y = int(std::floor(box.min().y() - pad)); y <= int(box.max().y() + pad); ++y) {
      for (int x = int(std::floor(box.min().x() - pad)); x <= int(box.max().x() + pad); ++x) {
        const Eigen::Vector2f center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        blend(image, x, y, color, radius_px + 0.5f - distance(glyph, center, left, baseline));
      }
    }
  }

  float distance(const Glyph& glyph, const Eigen::Vector2f& p, float left, float baseline) const {
    float least = std::numeric_limits<float>::infinity();
    for (const auto& stroke : glyph.strokes) {
      for (size_t i = 0; i < std::max<size_t>(1, stroke.size() - 1); ++i) {
        const Eigen::Vector2f& end = stroke[std::min(i + 1, stroke.size() - 1)];
        least = std::min(
            least, distance_to_segment(p, pixel(stroke[i], left, baseline), pixel(end, left, baseline)));
      }
    }
    return least;
  }
};

}  // namespace

float text_width(std::string_view text, const TextStyle& style) {
  float width = 0;
  for (const char character : text) width += glyph(character).advance;
  return width * style.size_px / kCapHeight;
}

std::string cut_to(std::string text, float width_px, const TextStyle& style) {
  if (text_width(text, style) <= width_px) return text;
  while (!text.empty() && text_width(text + "...", style) > width_px) text.pop_back();
  return text + "...";
}

void draw_text(Image& image, float x, float y, std::string_view text, const TextStyle& style) {
  const float scale = style.size_px / kCapHeight;
  const Pen pen{image, scale, 0.5f * style.weight * scale, style.color};
  for (const char character : text) {
    pen.draw(glyph(character), x, y);
    x += scale * glyph(character).advance;
  }
}

void draw_text_centered(Image& image, float center_x, float y, std::string_view text,
                        const TextStyle& style) {
  draw_text(image, center_x - 0.5f * text_width(text, style), y, text, style);
}

void draw_text_right(Image& image, float right_x, float y, std::string_view text, const TextStyle& style) {
  draw_text(image, right_x - text_width(text, style), y, text, style);
}

}  // namespace sinew::render

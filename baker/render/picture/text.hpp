// text.hpp  Words in pictures.
#pragma once
#include <string>
#include <string_view>

#include "baker/render/picture/image.hpp"

namespace sinew::render {

inline constexpr RgbBytes kInk{38, 44, 54};
inline constexpr RgbBytes kPaleInk{96, 104, 118};
inline constexpr RgbBytes kPaper{250, 251, 252};

struct TextStyle {
  float size_px = 12;    // height of capitals
  float weight = 1.15f;  // pen width in font units; bold from about 1.5
  RgbBytes color = kInk;
};

float text_width(std::string_view text, const TextStyle& style = {});
// The text, or its beginning and three dots where it is wider.
std::string cut_to(std::string text, float width_px, const TextStyle& style = {});
// x: left end, y: baseline, pixels from the top left corner. Clips at the edges.
void draw_text(Image& image, float x, float y, std::string_view text, const TextStyle& style = {});
void draw_text_centered(Image& image, float center_x, float y, std::string_view text,
                        const TextStyle& style = {});
void draw_text_right(Image& image, float right_x, float y, std::string_view text,
                     const TextStyle& style = {});

}  // namespace sinew::render

// image.hpp  Eight-bit sRGB pixels, and PNG files of them.
#pragma once
#include <string>
#include <vector>

#include "baker/render/picture/color.hpp"

namespace sinew::render {

struct Image {
  int width = 0, height = 0;
  std::vector<RgbBytes> pixels;  // row after row from the top

  Image() = default;
  Image(int w, int h, RgbBytes fill = {255, 255, 255})
      : width(w), height(h), pixels(static_cast<size_t>(w) * static_cast<size_t>(h), fill) {}
  RgbBytes& at(int x, int y) {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
  const RgbBytes& at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

// All of these clip at the edges.
void paste(const Image& source, int left, int top, Image& target);
void fill_box(Image& image, int left, int top, int width, int height, RgbBytes color);
// Mixes color into the pixel by coverage 0..1.
void blend(Image& image, int x, int y, RgbBytes color, float coverage);
// Filtered; width : height is kept and both fit. Never larger than the source.
Image shrink(const Image& source, int max_width, int max_height);

// Throws baker::BadInput when the path cannot be written.
void write_png(const std::string& path, const Image& image);

}  // namespace sinew::render

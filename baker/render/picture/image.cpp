// image.cpp  see image.hpp.
#include "baker/render/picture/image.hpp"

#include <stb/stb_image_resize.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cmath>

#include "baker/common/files/write_file.hpp"

namespace sinew::render {

void paste(const Image& source, int left, int top, Image& target) {
  const int first = std::max(0, -left), last = std::min(source.width, target.width - left);
  for (int y = std::max(0, -top); y < std::min(source.height, target.height - top); ++y) {
    for (int x = first; x < last; ++x) target.at(left + x, top + y) = source.at(x, y);
  }
}

void fill_box(Image& image, int left, int top, int width, int height, RgbBytes color) {
  for (int y = std::max(0, top); y < std::min(image.height, top + height); ++y) {
    for (int x = std::max(0, left); x < std::min(image.width, left + width); ++x) image.at(x, y) = color;
  }
}

void blend(Image& image, int x, int y, RgbBytes color, float coverage) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height || coverage <= 0) return;
  RgbBytes& pixel = image.at(x, y);
  const float share = std::min(coverage, 1.0f);
  for (size_t c = 0; c < 3; ++c) {
    pixel[c] = static_cast<uint8_t>(
        std::lround(static_cast<float>(pixel[c]) * (1 - share) + static_cast<float>(color[c]) * share));
  }
}

Image shrink(const Image& source, int max_width, int max_height) {
  const double scale = std::min({1.0, double(max_width) / source.width, double(max_height) / source.height});
  Image out(std::max(1, int(source.width * scale)), std::max(1, int(source.height * scale)));
  stbir_resize_uint8_srgb(source.pixels.data()->data(), source.width, source.height, 3 * source.width,
                          out.pixels.data()->data(), out.width, out.height, 3 * out.width, 3,
                          STBIR_ALPHA_CHANNEL_NONE, 0);
  return out;
}

void write_png(const std::string& path, const Image& image) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
  };
  stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.pixels.data(), 3 * image.width);
  baker::write_file(path, std::string_view(bytes));
}

}  // namespace sinew::render

// lines.cpp  see lines.hpp.
#include "baker/render/picture/lines.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace sinew::render {
namespace {

// The coverage of a pixel is the largest of any segment's: joints are not drawn twice.
class CoverageMap {
 public:
  explicit CoverageMap(const Image& image)
      : width_(image.width), height_(image.height), coverage_(image.pixels.size(), 0.0f) {}

  void add(const Eigen::Vector2f& a, const Eigen::Vector2f& b, float radius) {
    Eigen::AlignedBox2f box(a.cwiseMin(b), a.cwiseMax(b));
    const float pad = radius + 1;
    const int left = std::max(0, int(box.min().x() - pad)),
              right = std::min(width_ - 1, int(box.max().x() + pad));
    const int top = std::max(0, int(box.min().y() - pad)),
              bottom = std::min(height_ - 1, int(box.max().y() + pad));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const Eigen::Vector2f center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        float& here =
            coverage_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
        here = std::max(here, radius + 0.5f - distance_to_segment(center, a, b));
      }
    }
  }

  void blend_into(Image& image, RgbBytes color) const {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        blend(image, x, y, color,
              coverage_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)]);
      }
    }
  }

 private:
  int width_, height_;
  std::vector<float> coverage_;
};

}  // namespace

void draw_polyline(Image& image, std::span<const Eigen::Vector2f> points, float width_px, RgbBytes color) {
  CoverageMap map(image);
  for (size_t i = 0; i + 1 < points.size(); ++i) map.add(points[i], points[i + 1], 0.5f * width_px);
  map.blend_into(image, color);
}

}  // namespace sinew::render

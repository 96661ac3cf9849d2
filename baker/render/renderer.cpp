// renderer.cpp  see renderer.hpp.
#include "baker/render/renderer.hpp"

#include <cmath>

#include "baker/render/parallel.hpp"
#include "baker/render/sampling.hpp"
#include "baker/render/shading.hpp"

namespace sinew::render {
namespace {

constexpr int kTile = 16;
// A highlight brighter than this would take more samples than we spend to settle.
constexpr float kBrightest = 4;

struct Painter {
  const Shading& shading;
  Rays rays;
  const RenderOptions& options;
  Image& image;

  Rgb pixel(int x, int y) const {
    const PixelSamples place(x, y, 0), key(x, y, 1), sky(x, y, 2);
    Rgb sum = Rgb::Zero();
    for (uint32_t s = 0; s < static_cast<uint32_t>(options.samples); ++s) {
      const Eigen::Vector2f p = place(s);
      const float right = 2 * (static_cast<float>(x) + p.x()) / static_cast<float>(options.width) - 1;
      const float up = 1 - 2 * (static_cast<float>(y) + p.y()) / static_cast<float>(options.height);
      sum += shading.along(rays.origin, rays.direction(right, up), {key(s), sky(s)}).cwiseMin(kBrightest);
    }
    return sum / static_cast<float>(options.samples);
  }

  void tile(int left, int top) const {
    for (int y = top; y < std::min(top + kTile, options.height); ++y) {
      for (int x = left; x < std::min(left + kTile, options.width); ++x) {
        image.at(x, y) = srgb_from_linear(tone_map(pixel(x, y)));
      }
    }
  }
};

}  // namespace

Image render(const Mesh& mesh, const Camera& camera, const RenderOptions& options) {
  const Scene scene(mesh);
  const Shading shading(mesh, scene, camera, options);
  Image image(options.width, options.height);
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  const Painter painter{shading, Rays(camera, aspect), options, image};
  const int columns = (options.width + kTile - 1) / kTile, rows = (options.height + kTile - 1) / kTile;
  parallel_for(columns * rows, options.threads,
               [&](int index) { painter.tile(index % columns * kTile, index / columns * kTile); });
  return image;
}

float grid_for_height(float height_m) {
  const float rough = std::max(height_m, 1e-6f) / 4;
  const float decade = std::pow(10.0f, std::floor(std::log10(rough)));
  const float digit = rough / decade;
  return decade * (digit < 1.5f ? 1.0f : digit < 3.5f ? 2.0f : digit < 7.5f ? 5.0f : 10.0f);
}

}  // namespace sinew::render

// renderer.cpp  Pictures: the same every time, the right outline, light and shadow where they belong.
#include <catch2/catch.hpp>
#include <numeric>

#include "baker/render/renderer.hpp"
#include "tests/baker/render/shapes.hpp"

using namespace sinew::render;
using sinew::test::sphere;

namespace {

constexpr int kSide = 96;
const Rgb kGreen(0.05f, 0.6f, 0.05f);

RenderOptions small(int samples = 8) {
  RenderOptions options;
  options.width = options.height = kSide;
  options.samples = samples;
  options.threads = 1;
  return options;
}

bool is_green(RgbBytes pixel) { return pixel[1] > 40 + (pixel[0] + pixel[2]) / 2; }

double brightness(const Image& image, int left, int top, int width, int height) {
  double sum = 0;
  for (int y = top; y < top + height; ++y) {
    for (int x = left; x < left + width; ++x)
      sum += std::accumulate(image.at(x, y).begin(), image.at(x, y).end(), 0.0);
  }
  return sum / (3.0 * width * height);
}

}  // namespace

TEST_CASE("empty_mesh_renders_as_an_empty_studio") {
  const Image image = render(
      Mesh{}, camera_around(Eigen::AlignedBox3f(Eigen::Vector3f(-1, 0, -1), Eigen::Vector3f(1, 2, 1)), 1),
      small());
  CHECK(brightness(image, 0, 0, kSide, kSide) > 100);
}

TEST_CASE("picture_is_the_same_on_every_run_and_for_any_number_of_threads") {
  const Mesh mesh = sphere({0, 0.5f, 0}, 0.5f, kGreen);
  const Camera camera = camera_around(mesh.positions, 1);
  RenderOptions options = small();
  const Image first = render(mesh, camera, options);
  CHECK(render(mesh, camera, options).pixels == first.pixels);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    CHECK(render(mesh, camera, options).pixels == first.pixels);
  }
}

TEST_CASE("sphere_covers_the_area_of_its_projection") {
  const Mesh mesh = sphere({0, 0, 0}, 1, kGreen, 128);
  const float distance = 6;
  const Camera camera{{0, 0, distance}, {0, 0, 0}, 30};
  RenderOptions options = small();
  options.floor_y = -50;
  options.grid_m = 0;
  const Image image = render(mesh, camera, options);
  double covered = 0;
  for (const RgbBytes& pixel : image.pixels) covered += is_green(pixel);
  const double radius_px =
      1 / std::sqrt(distance * distance - 1) / std::tan(15 * std::numbers::pi / 180) * kSide / 2;
  CHECK(covered ==
        Approx(std::numbers::pi * radius_px * radius_px).epsilon(0.02));  // pixels of the rim are in or out
}

TEST_CASE("side_towards_the_key_light_is_brighter") {
  const Mesh mesh = sphere({0, 0, 0}, 1, kGreen);
  const Camera camera{{0, 0, 6}, {0, 0, 0}, 30};
  RenderOptions options = small(32);
  options.floor_y = -50;
  const Image image = render(mesh, camera, options);
  const int third = kSide / 3;
  CHECK(brightness(image, third, third, 8, 8) > 1.3 * brightness(image, 2 * third - 8, 2 * third - 8, 8, 8));
}

TEST_CASE("floor_is_darker_in_the_shadow_and_unchanged_far_away") {
  const Mesh mesh = sphere({0, 0.5f, 0}, 0.5f, kGreen);
  const Camera camera{{0, 8, 0.01f}, {0, 0, 0}, 60};  // from above: +x is right, +z is down
  RenderOptions options = small(32);
  options.grid_m = 0;
  options.studio.key_direction = Eigen::Vector3f(-1, 1, 0).normalized();
  const Image with = render(mesh, camera, options);
  Mesh away = mesh;
  for (Eigen::Vector3f& p : away.positions) p.y() += 1000;
  const Image without = render(sphere({0, 1000, 0}, 0.5f, kGreen), camera, options);
  const int center = kSide / 2,
            metre = static_cast<int>(kSide / 2 / (8 * std::tan(30 * std::numbers::pi / 180)));
  const int shadow = center + static_cast<int>(0.9 * metre), lit = center - static_cast<int>(0.9 * metre);
  CHECK(brightness(with, shadow - 2, center - 2, 4, 4) < 0.85 * brightness(with, lit - 2, center - 2, 4, 4));
  CHECK(brightness(with, 2, 2, 8, 8) == Approx(brightness(without, 2, 2, 8, 8)).epsilon(0.03));
}

TEST_CASE("vertex_colors_come_through_at_their_brightness") {
  // A grey that fills the view, lit from all sides alike, shows as a grey near its own sRGB value.
  const Mesh mesh = sphere({0, 0, 0}, 1, linear_from_srgb({150, 150, 150}));
  RenderOptions options = small(64);
  options.floor_y = -50;
  options.gloss = 0;
  options.studio.key = Rgb::Zero();
  options.studio.sky_zenith = options.studio.sky_horizon = options.studio.bounce = Rgb::Ones();
  const Image image = render(mesh, {{0, 0, 6}, {0, 0, 0}, 30}, options);
  const RgbBytes shown = srgb_from_linear(tone_map(linear_from_srgb({150, 150, 150})));
  CHECK(brightness(image, kSide / 2 - 8, kSide / 2 - 8, 16, 16) == Approx(shown[0]).margin(1.5));
}

TEST_CASE("grid_spacing_is_a_round_length") {
  CHECK(grid_for_height(1.0f) == Approx(0.2));
  CHECK(grid_for_height(1.8f) == Approx(0.5));
  CHECK(grid_for_height(0.04f) == Approx(0.01));
}

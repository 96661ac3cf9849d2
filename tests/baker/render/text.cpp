// text.cpp  Labels: the ink is where it should be.
#include <catch2/catch.hpp>
#include <set>

#include "baker/render/picture/stroke_font.hpp"
#include "baker/render/picture/text.hpp"

using namespace sinew::render;

namespace {

constexpr RgbBytes kWhite{255, 255, 255}, kBlack{0, 0, 0};

int ink(const Image& image, int left = 0, int top = 0, int right = 1 << 20, int bottom = 1 << 20) {
  int count = 0;
  for (int y = top; y < std::min(bottom, image.height); ++y) {
    for (int x = left; x < std::min(right, image.width); ++x) count += image.at(x, y) != kWhite;
  }
  return count;
}

}  // namespace

TEST_CASE("text_off_the_picture_is_clipped") {
  Image image(20, 10);
  draw_text(image, -500, 5, "left");
  draw_text(image, 5, 400, "below");
  CHECK(ink(image) == 0);
  draw_text(image, -8, 8, "edge", {.size_px = 30});
  CHECK(ink(image) > 0);
}

TEST_CASE("every_printable_character_has_strokes_of_its_own") {
  std::set<std::string> shapes;
  for (char c = '!'; c <= '~'; ++c) {
    REQUIRE_FALSE(glyph(c).strokes.empty());
    std::string shape;
    for (const auto& stroke : glyph(c).strokes) {
      shape += '|';
      for (const auto& p : stroke) shape += std::to_string(p.x()) + "," + std::to_string(p.y()) + " ";
    }
    shapes.insert(shape);
    CHECK(glyph(c).advance > 0);
  }
  CHECK(shapes.size() == '~' - '!' + 1);
  CHECK(glyph(' ').strokes.empty());
  CHECK(&glyph('\xe9') == &glyph('\n'));  // the box
}

TEST_CASE("digits_are_equally_wide") {
  for (char c = '0'; c <= '9'; ++c) CHECK(text_width(std::string(1, c)) == text_width("0"));
}

TEST_CASE("text_stays_in_its_box_and_grows_with_its_size") {
  for (const float size : {10.0f, 20.0f}) {
    Image image(200, 60);
    const TextStyle style{.size_px = size, .color = kBlack};
    draw_text(image, 20, 40, "HOP 12", style);
    const int right = 20 + static_cast<int>(text_width("HOP 12", style)) + 2;
    const int top = 40 - static_cast<int>(size) - 3;
    CHECK(ink(image, 18, top, right, 43) > 30);
    CHECK(ink(image) == ink(image, 18, top, right, 43));
  }
  CHECK(text_width("abc", {.size_px = 20}) == Approx(2 * text_width("abc", {.size_px = 10})));
}

// layout.cpp  Panels, contact sheets, legends, PNG files.
#include <stb/stb_image.h>

#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "baker/render/picture/encode.hpp"
#include "baker/render/picture/layout.hpp"
#include "baker/render/picture/text.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew::render;
using sinew::test::TemporaryFolder;

namespace {

constexpr RgbBytes kRed{200, 10, 10}, kBlue{10, 10, 200};

}  // namespace

TEST_CASE("png_into_a_folder_that_is_not_there_is_refused") {
  TemporaryFolder folder;
  CHECK_THROWS_AS(write_png(folder.file("none/picture.png"), Image(2, 2)), sinew::baker::BadInput);
  CHECK(folder.entries() == 0);
}

TEST_CASE("png_holds_the_same_pixels") {
  TemporaryFolder folder;
  Image image(5, 3, kRed);
  image.at(4, 2) = kBlue;
  write_png(folder.file("picture.png"), image);
  int width = 0, height = 0, channels = 0;
  uint8_t* read = stbi_load(folder.file("picture.png").c_str(), &width, &height, &channels, 3);
  REQUIRE(read != nullptr);
  CHECK((width == 5 && height == 3 && channels == 3));
  CHECK(std::equal(read, read + 45, image.pixels.data()->data()));
  stbi_image_free(read);
}

TEST_CASE("panels_lie_side_by_side_in_order") {
  const Panel panels[] = {{Image(30, 20, kRed), "", ""}, {Image(40, 25, kBlue), "", ""}};
  const Image image = side_by_side(panels, 6);
  CHECK((image.width == 76 && image.height == 25));
  CHECK(image.at(29, 19) == kRed);
  CHECK(image.at(36, 24) == kBlue);
  CHECK(image.at(32, 10) == RgbBytes{255, 255, 255});
}

TEST_CASE("panel_titles_are_drawn") {
  const Panel panels[] = {{Image(200, 100, kRed), "Sinew", "hop"}};
  const Image image = side_by_side(panels);
  CHECK(std::count(image.pixels.begin(), image.pixels.end(), kInk) > 10);
}

TEST_CASE("contact_sheet_is_filled_row_by_row") {
  std::vector<Cell> cells(5, Cell{Image(20, 10, kRed), "caption"});
  cells[3].image = Image(20, 10, kBlue);
  const Image image = contact_sheet(cells, 3);
  int first_blue_x = image.width, first_blue_y = image.height, red = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      red += image.at(x, y) == kRed;
      if (image.at(x, y) != kBlue) continue;
      first_blue_x = std::min(first_blue_x, x);
      first_blue_y = std::min(first_blue_y, y);
    }
  }
  CHECK(red == 4 * 200);
  CHECK(first_blue_x < 20);                                              // first column
  CHECK(first_blue_y > 10);                                              // second row
  CHECK(contact_sheet(cells, 0).width < contact_sheet(cells, 5).width);  // as square as it comes
  CHECK(contact_sheet({}, 0).width > 0);
}

TEST_CASE("legend_shows_the_ramp_from_end_to_end") {
  Image image(300, 200, {225, 228, 233});
  draw_legend(image, {.title = "error (mm)", .high = 12});
  CHECK(std::count(image.pixels.begin(), image.pixels.end(), srgb_from_linear(ramp(0))) > 3);
  CHECK(std::count(image.pixels.begin(), image.pixels.end(), srgb_from_linear(ramp(1))) > 3);
  const auto dark = [](RgbBytes p) {
    return p[0] < 130 && p[1] < 130 && p[2] > 40;
  };  // letters, not the ramp
  CHECK(std::count_if(image.pixels.begin(), image.pixels.end(), dark) > 40);
}

TEST_CASE("shrunk_pictures_keep_their_shape") {
  const Image small = shrink(Image(300, 100, kRed), 60, 60);
  CHECK((small.width == 60 && small.height == 20));
  CHECK(small.at(30, 10) == kRed);
  CHECK(shrink(Image(30, 10, kRed), 60, 60).width == 30);  // never larger
}

TEST_CASE("numbers_are_short") {
  CHECK(short_number(0.0312) == "0.0312");
  CHECK(short_number(12.345) == "12.3");
  CHECK(short_number(1234.5) == "1234");
}

TEST_CASE("film_that_cannot_be_made_says_so_in_one_line") {
  TemporaryFolder folder;
  SECTION("no ffmpeg") {
    const std::string path = ::getenv("PATH");
    ::setenv("PATH", folder.path().c_str(), 1);
    const std::string trouble =
        encode({.pattern = folder.file("frame_%04d.png"), .path = folder.file("film.mp4")});
    ::setenv("PATH", path.c_str(), 1);
    CHECK_THAT(trouble, Catch::Contains("ffmpeg is not installed"));
    CHECK(trouble.find('\n') == std::string::npos);
  }
  CHECK(folder.entries() == 0);
}

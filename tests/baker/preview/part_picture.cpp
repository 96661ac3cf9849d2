// part_picture.cpp  Pictures of what moves by itself.
#include "baker/preview/part_picture.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "baker/common/bad_input.hpp"
#include "baker/preview/write_preview.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/scenes/soft_block.hpp"

using namespace sinew;

namespace {

struct Opened {
  scenes::PackBytes bytes;
  pack::PackView view;
  explicit Opened(const scenes::BlockOptions& options) : bytes(scenes::soft_block(options)) {
    REQUIRE(pack::open_pack(bytes.bytes(), &view).ok());
  }
};

constexpr baker::PartPicture kSmall{.width = 200, .height = 120, .samples = 2};

// Pixels of the two views in which red, green or blue stands out.
int vivid(const render::Image& image, size_t channel) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < kSmall.width; ++x) {
      const render::RgbBytes& p = image.at(x, y);
      const int others = std::max(p[(channel + 1) % 3], p[(channel + 2) % 3]);
      count += p[channel] > others + 60;
    }
  return count;
}

}  // namespace

TEST_CASE("a_preview_that_cannot_be_written_is_refused_by_its_path") {
  const sinew::test::TemporaryFolder folder;
  const Opened block(scenes::BlockOptions{});
  CHECK_THROWS_AS(baker::write_preview(folder.file("none/out.png"), block.view), baker::BadInput);
  CHECK(folder.entries() == 0);
}

TEST_CASE("a_preview_shows_soft_parts_in_colours_and_rods_as_lines") {
  const Opened two({.regions = 2}), tailed({.regions = 2, .rods = scenes::RodMatter{}});
  const render::Image soft = baker::part_picture(two.view, kSmall);
  CHECK(soft.height == kSmall.height);
  CHECK(soft.width > kSmall.width);  // and the legend
  CHECK(vivid(soft, 0) > 100);       // the first part is red, from both sides
  CHECK(vivid(soft, 2) > 50);        // the second blue
  CHECK(vivid(soft, 1) == 0);        // the block is not green
  const render::Image rods = baker::part_picture(tailed.view, kSmall);
  CHECK(vivid(rods, 1) > 5);  // the second rod's line
}

TEST_CASE("a_preview_of_a_character_is_the_same_twice_and_written_as_png") {
  const sinew::test::TemporaryFolder folder;
  const Opened block(scenes::BlockOptions{});
  CHECK(baker::part_picture(block.view, kSmall).pixels == baker::part_picture(block.view, kSmall).pixels);
  baker::write_preview(folder.file("out.png"), block.view);
  CHECK(folder.entries() == 1);
}

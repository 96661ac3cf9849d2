// test_portrait.cpp  sinew-portrait as a user calls it.
#include <stb/stb_image.h>

#include <catch2/catch.hpp>

#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/import/tiny_file.hpp"
#include "tests/baker/programs/run_program.hpp"

using sinew::test::ProgramResult;
using sinew::test::TemporaryFolder;

namespace {

ProgramResult portrait(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SINEW_PORTRAIT);
  for (const char* small : {"--width", "32", "--height", "32", "--samples", "1"}) arguments.push_back(small);
  return sinew::test::run_program(arguments);
}

void check_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
  const ProgramResult result = portrait(arguments);
  INFO(result.error);
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.error, Catch::StartsWith("sinew-portrait: "));
  CHECK(result.error.find('\n') == result.error.size() - 1);
  for (const std::string& word : words) CHECK_THAT(result.error, Catch::Contains(word));
}

// Pictures on the sheet, by its width at 32 pixels each and gaps of 8.
int columns_of(const std::string& path) {
  int width = 0, height = 0, channels = 0;
  uint8_t* pixels = stbi_load(path.c_str(), &width, &height, &channels, 3);
  REQUIRE(pixels != nullptr);
  stbi_image_free(pixels);
  return (width - 8) / 40;
}

}  // namespace

TEST_CASE("portrait_refuses_what_it_cannot_draw") {
  TemporaryFolder folder;
  const std::string out = folder.file("out.png"), bar_file = bar().write("portrait_bar");
  check_refused({folder.file("none.glb"), "-o", out}, {"none.glb"});
  check_refused({write_bytes("empty.glb", ""), "-o", out}, {"empty.glb"});
  check_refused({bar_file}, {"--output"});
  check_refused({bar_file, "-o", out, "--clip", "hop"}, {"hop", "it has none"});
  check_refused({bar_file, "-o", out, "--clips"}, {"no clips"});
  check_refused({bar_file, "-o", out, "--stiffness"}, {"_STIFFNESS"});
  check_refused({bar_file, "-o", folder.file("out.gif")}, {"--turntable"});
  check_refused({bar_file, "-o", folder.file("none/out.png")}, {"out.png"});
  CHECK(folder.entries() == 0);
}

TEST_CASE("portrait_draws_sides_turns_and_clips") {
  TemporaryFolder folder;
  TinyFile file = bar();
  file.animate(1, "translation", "LINEAR", {0, 1}, {0, 1, 0, 0.5f, 1, 0});
  const std::string path = file.write("portrait_clip"), out = folder.file("out.png");
  REQUIRE(portrait({path, "-o", out}).exit_code == 0);
  CHECK(columns_of(out) == 2);
  REQUIRE(portrait({path, "-o", out, "--turntable"}).exit_code == 0);
  CHECK(columns_of(out) == 4);
  const ProgramResult clips = portrait({path, "-o", out, "--clips"});
  REQUIRE(clips.exit_code == 0);
  CHECK(clips.error.empty());
  CHECK(columns_of(out) == 6);
}

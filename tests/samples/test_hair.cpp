// test_hair.cpp  sinew-hair as a user calls it.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/run_program.hpp"

using namespace sinew;
using test::ProgramResult;
using test::TemporaryFolder;

namespace {

ProgramResult hair(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SINEW_HAIR);
  for (const char* small : {"--width", "32", "--height", "32", "--samples", "1", "--strands", "16"})
    arguments.push_back(small);
  return test::run_program(arguments);
}

double number_after(const std::string& text, const std::string& words) {
  const size_t at = text.find(words);
  REQUIRE(at != std::string::npos);
  return std::strtod(text.c_str() + at + words.size(), nullptr);
}

}  // namespace

TEST_CASE("hair_refuses_what_it_cannot_do") {
  TemporaryFolder folder;
  const std::vector<std::vector<std::string>> bad = {{},
                                                     {"-o", folder.file("out"), "--against", "wind"},
                                                     {"-o", folder.file("out"), "--steps", "0"},
                                                     {"-o", folder.file("out"), "--yaw", "nan"},
                                                     {"-o", "/dev/null/out"}};
  for (const auto& arguments : bad) {
    const ProgramResult result = hair(arguments);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.error, Catch::StartsWith("sinew-hair: "));
  }
  CHECK(folder.entries() == 0);
}

TEST_CASE("hair_on_a_turning_character_stays_out_of_its_skin") {
  TemporaryFolder folder;
  const ProgramResult result = hair({"-o", folder.file("out"), "--against", "nothing", "--against", "skin",
                                     "--steps", "300", "--vertices", "3000"});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  const size_t skin = result.out.find("skin");
  REQUIRE(skin != std::string::npos);
  CHECK(number_after(result.out, "deepest ") > 1);                 // what would be without
  CHECK(number_after(result.out.substr(skin), "deepest ") < 0.2);  // what is wanted; 0.06 seen
}

TEST_CASE("hair_touches_the_skin_where_its_tier_affords_it_and_is_off_it_again_after_capsules") {
  TemporaryFolder folder;
  const ProgramResult result =
      hair({"-o", folder.file("out"), "--against", "tiers", "--steps", "240", "--vertices", "3000"});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  const size_t coarser = result.out.find("coarser graph: rods touch capsules"),
               again = result.out.find("after that: rods touch the skin");
  REQUIRE(result.out.find("finest graph: rods touch the skin") == 0);
  REQUIRE(coarser != std::string::npos);
  REQUIRE(again != std::string::npos);
  CHECK(number_after(result.out, "deepest ") < 0.2);                // as above
  CHECK(number_after(result.out.substr(coarser), "deepest ") > 1);  // no capsule is a chest
  CHECK(number_after(result.out.substr(again), "deepest ") < 0.2);  // none was trapped
  CHECK(number_after(result.out, "to capsules moves the end of a bone by ") < 6);
  CHECK(number_after(result.out, "to the skin moves the end of a bone by ") < 6);
}

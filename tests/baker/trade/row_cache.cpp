// row_cache.cpp  Rows that were measured before are taken up again, and never another machine's or source's.
#include "baker/trade/row_cache.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "baker/common/write_file.hpp"
#include "baker/trade/made_of.hpp"
#include "sinew/isa.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using namespace sinew::test;

namespace {

nlohmann::ordered_json small_made_of(const BakedFrom& source) {
  return made_of(LoadedPack::from_bytes(small_character_pack(), "small"), {}, source);
}

Row measured_row() {
  Row row;
  row.name = "modal";
  row.kind = "tier";
  row.warm.mean_us = 7;
  return row;
}

}  // namespace

TEST_CASE("rows_of_another_program_processor_instruction_set_or_source_are_not_taken_up") {
  const TemporaryFolder folder;
  const std::string path = folder.file("measured.json");
  const nlohmann::ordered_json made_of = small_made_of({});
  for (const char* name :
       {"program", "processor", "instruction set", "character", "motions", "source, recipe or weights"}) {
    INFO(name);
    REQUIRE(made_of.contains(name));
    std::filesystem::remove(path);
    RowCache(path, made_of).add(measured_row());
    CHECK(RowCache(path, made_of).find("modal")->warm.mean_us == 7);
    nlohmann::ordered_json another = made_of;
    another[name] = "another";
    CHECK_FALSE(RowCache(path, another).find("modal"));
  }
}

TEST_CASE("what_rows_are_made_of_tells_instruction_sets_recipes_and_weights_apart") {
  const TemporaryFolder folder;
  const std::string file = folder.file("file");
  write_file(file, std::string_view("some bytes"));
  const nlohmann::ordered_json first = small_made_of({.glb = "", .recipe = file, .weights = {file}});
  CHECK(first == small_made_of({.glb = "", .recipe = file, .weights = {file}}));
  CHECK(first != small_made_of({.glb = "", .recipe = file, .weights = {}}));
  const std::string isa = active_isa();
  REQUIRE(force_isa("scalar").ok());
  CHECK(first != small_made_of({.glb = "", .recipe = file, .weights = {file}}));
  REQUIRE(force_isa(isa.c_str()).ok());
  write_file(file, std::string_view("other bytes"));
  CHECK(first != small_made_of({.glb = "", .recipe = file, .weights = {file}}));
}

// row_cache.cpp  Rows that were measured before are taken up again, and never another machine's or source's.
#include "baker/trade/rows/row_cache.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "baker/common/files/write_file.hpp"
#include "baker/trade/source/made_of.hpp"
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

Row measured_row(const std::string& name = "modal") {
  Row row;
  row.name = name;
  row.kind = "tier";
  row.tier = Tier::kModal;
  row.warm = row.cold = {.p50_us = 7, .p99_us = 9};
  row.error = {{.mean_mm = 1, .sd_mm = 2, .p95_mm = 3, .worst_mm = 4, .ratio = 0.1},
               {.mean_mm = 2, .sd_mm = 3, .p95_mm = 4, .worst_mm = 5, .ratio = 0.2}};
  return row;
}

// The file's second row of three, changed.
void change_row(const std::string& path, const nlohmann::json& made_of, const nlohmann::json& second) {
  nlohmann::json file = {{"made_of", made_of}, {"rows", nlohmann::json::array()}};
  file["rows"] = {to_json(measured_row("first")), second, to_json(measured_row("third"))};
  write_file(path, std::string_view(file.dump()));
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
    CHECK(RowCache(path, made_of).find(measured_row())->warm.p50_us == 7);
    nlohmann::ordered_json another = made_of;
    another[name] = "another";
    CHECK_FALSE(RowCache(path, another).find(measured_row()));
  }
}

// Whatever was done to the file: a row either holds all figures, or is measured anew.
TEST_CASE("a_row_without_its_figures_is_left_out_and_the_rows_beside_it_are_not") {
  const TemporaryFolder folder;
  const std::string path = folder.file("measured.json");
  const nlohmann::json made_of = small_made_of({}), whole = to_json(measured_row());
  const auto is_taken_up = [&](const nlohmann::json& row) {
    change_row(path, made_of, row);
    const RowCache cache(path, made_of);
    CHECK(cache.find(measured_row("first")));
    CHECK(cache.find(measured_row("third")));
    return cache.find(measured_row()).has_value();
  };
  REQUIRE(is_taken_up(whole));
  for (const auto& [key, value] : whole.items()) {
    if (key == "dominated_by" || key == "bought") continue;  // found anew
    INFO(key);
    nlohmann::json row = whole;
    row.erase(key);
    CHECK_FALSE(is_taken_up(row));
    for (const nlohmann::json& other :
         {nlohmann::json(), nlohmann::json(-1), nlohmann::json("much"), nlohmann::json::array({1}),
          nlohmann::json(true), nlohmann::json({{"p50_us", 1}, {"p99_us", nullptr}})}) {
      INFO(other.dump());
      row[key] = other;
      CHECK_FALSE(is_taken_up(row));
    }
  }
  for (const char* cost : {"warm", "cold"})
    for (const char* of : {"p50_us", "p99_us"}) {
      nlohmann::json row = whole;
      row[cost][of] = 0;  // no step takes no time
      CHECK_FALSE(is_taken_up(row));
      row[cost].erase(of);
      CHECK_FALSE(is_taken_up(row));
    }
  for (const nlohmann::json& row : {nlohmann::json(), nlohmann::json(7), nlohmann::json::array({whole})})
    CHECK_FALSE(is_taken_up(row));
}

TEST_CASE("a_row_of_that_name_that_ran_another_way_is_not_taken_up") {
  const TemporaryFolder folder;
  const std::string path = folder.file("measured.json");
  const nlohmann::ordered_json made_of = small_made_of({});
  const std::pair<const char*, nlohmann::json> others[] = {
      {"kind", "variant"}, {"tier", 2}, {"tier", 5}, {"level", 1}, {"level", 4294967297}};
  for (const auto& [key, value] : others) {
    INFO(key);
    nlohmann::json row = to_json(measured_row());
    row[key] = value;
    change_row(path, made_of, row);
    RowCache cache(path, made_of);
    CHECK_FALSE(cache.find(measured_row()));
    cache.add(measured_row());
    CHECK(RowCache(path, made_of).find(measured_row()));
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

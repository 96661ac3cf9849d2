// hop_of_crowd.cpp  see hop_of_crowd.hpp.
#include "tests/perf/hop_of_crowd.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "baker/measure/yardstick.hpp"
#include "baker/trade/report/write_tiers.hpp"

namespace sinew::test {
namespace {

// Baked, so that runs by baked costs are all alike.
constexpr double kShownCost_us = 4, kModalCost_us = 20, kNetworkCost_us = 80;

// The creature with its tiers' errors along that hop.
void bake_tiers(const CreatureHop& hop) {
  const auto character = baker::LoadedPack::from_file(hop.pack);
  const std::vector<baker::TrueSurface> surfaces = {{hop.truth, character.view()}};
  const baker::Yardstick yardstick(character, surfaces);
  const auto row = [](Tier tier, double us, const baker::Error& error) {
    return baker::Row{.name = {},
                      .kind = "tier",
                      .tier = tier,
                      .warm = {us, us},
                      .cold = {},
                      .error = error,
                      .dominated_by = {}};
  };
  const std::vector<baker::Row> rows = {
      row(Tier::kSkinning, 0, yardstick.of_skinning()),
      row(Tier::kExtrapolate, kShownCost_us, yardstick.of_extrapolation(character, baker::kCarriedTicks)),
      row(Tier::kModal, kModalCost_us, yardstick.of(character, Tier::kModal, 0)),
      row(Tier::kNetwork, kNetworkCost_us, yardstick.of(character, Tier::kNetwork, 0))};
  baker::write_with_tiers(hop.folder.file("tiered.sinew"), character, baker::tier_records(rows));
}

void make_more(const CreatureHop& hop) {
  bake_tiers(hop);
  must(bake({"truth", hop.glb, "--recipe", hop.recipe, "--motion", "clip:hop", "--seconds", "1.6",
             "--positions", "-o", hop.folder.file("long.safetensors")}));
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

}  // namespace

HopOfCrowd::HopOfCrowd()
    : hop_({.name = "hop_of_crowd", .source = __FILE__, .seconds = "1.5", .more = make_more}) {}

const HopOfCrowd& hop_of_crowd() {
  static const HopOfCrowd made;
  return made;
}

std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  REQUIRE(std::getline(lines, line));
  const std::vector<std::string> names = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    INFO(line);
    const std::vector<std::string> cells = cells_of(line);
    REQUIRE(cells.size() == names.size());
    rows.emplace_back();
    for (size_t i = 0; i < cells.size(); ++i) rows.back()[names[i]] = cells[i];
  }
  return rows;
}

double number(const Row& row, const std::string& column) {
  INFO(column << " " << row.at(column));
  const double value = std::stod(row.at(column));
  REQUIRE(std::isfinite(value));
  return value;
}

}  // namespace sinew::test

// test_default_settings.cpp  What is chosen for a kind of rod is what the committed measurements say.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "rods/default_settings.hpp"

using namespace sinew;

namespace {

const char* name_of(rods::RodStart start) {
  switch (start) {
    case rods::RodStart::kZero:
      return "zero";
    case rods::RodStart::kPrevious:
      return "previous";
    case rods::RodStart::kGiven:
      return "given";
    case rods::RodStart::kContinued:
      return "continued";
    case rods::RodStart::kLearned:
      return "learned";
  }
  return "";
}

struct Row {
  std::map<std::string, std::string> of;
  double number(const char* column) const { return std::stod(of.at(column)); }
  std::string option() const { return of.at("solver") + " " + of.at("start"); }
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, ',');) out.push_back(word);
  return out;
}

// Of one file, to a residual of 1e-4, by case.
std::map<std::string, std::vector<Row>> cases_of(const std::filesystem::path& path) {
  std::map<std::string, std::vector<Row>> out;
  std::ifstream file(path);
  std::vector<std::string> columns;
  for (std::string line; std::getline(file, line);) {
    if (line[0] == '#') continue;
    const std::vector<std::string> words = split(line);
    if (columns.empty()) {
      columns = words;
      continue;
    }
    REQUIRE(words.size() == columns.size());
    Row row;
    for (size_t i = 0; i < words.size(); ++i) row.of[columns[i]] = words[i];
    if (row.of.at("residual") != "1e-04") continue;
    const std::string key = row.of.at("scene") + "," + row.of.at("strands") + "," + row.of.at("segments") +
                            "," + row.of.at("young_pa");
    out[key].push_back(row);
  }
  return out;
}

rods::RodKind kind_of(const Row& row) {
  return {.segments = static_cast<uint32_t>(row.number("segments")),
          .young_pa = static_cast<float>(row.number("young_pa")),
          .tree = row.of.at("scene") == "tree",
          .contacts = row.of.at("scene") == "collisions"};
}

std::vector<std::filesystem::path> measurements(const char* of) {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::directory_iterator(SINEW_SOURCE_DIR "/perf/results")) {
    if (entry.path().filename().string().ends_with(of)) out.push_back(entry.path());
  }
  return out;
}

}  // namespace

TEST_CASE("no_other_settings_were_measured_to_be_faster_than_the_defaults") {
  // A case is a median of six states on a host that others use too; a scene's mean is over eighteen to
  // thirty.
  constexpr double kOfACase = 2, kOfAScene = 1.05;
  REQUIRE(!measurements("_rods_trade.csv").empty());
  for (const auto& path : measurements("_rods_trade.csv")) {
    struct Scene {
      int cases = 0;
      double own = 0;                        // sums of logarithms
      std::map<std::string, double> others;  // infinite where one case was not solved
    };
    std::map<std::string, Scene> scenes;
    for (const auto& [key, rows] : cases_of(path)) {
      const rods::RodSettings chosen = rods::default_settings(kind_of(rows[0]));
      const std::string option = std::string("direct ") + name_of(chosen.start);
      Scene& scene = scenes[rows[0].of.at("scene") + " x " + rows[0].of.at("strands")];
      double fastest = HUGE_VAL, own = -1;
      for (const Row& row : rows) {
        const double us = row.number("us_a_strand");
        fastest = std::min(fastest, us);
        scene.others[row.option()] += std::log(us);
        if (row.option() == option) own = us;
      }
      INFO(path.filename().string() << ": " << key << ", " << option << " " << own << " us, fastest "
                                    << fastest);
      REQUIRE(own > 0);
      scene.own += std::log(own);
      CHECK(own <= kOfACase * fastest);
      ++scene.cases;
    }
    for (const auto& [name, scene] : scenes) {
      for (const auto& [option, sum] : scene.others) {
        INFO(path.filename().string() << ": " << name << " with " << option);
        CHECK(std::exp((scene.own - sum) / scene.cases) <= kOfAScene);
      }
    }
  }
}

// Some steps of rods that slide are solved by none.
TEST_CASE("in_contact_no_other_settings_were_measured_to_be_faster_over_the_cases_that_both_solve") {
  constexpr double kOfAScene = 1.05;  // as above, where half the cases or more are solved by both
  REQUIRE(!measurements("_rods_contacts.csv").empty());
  for (const auto& path : measurements("_rods_contacts.csv")) {
    struct Both {
      int cases = 0;
      double own_over_other = 0;  // sum of logarithms
    };
    std::map<std::string, Both> others;
    const auto cases = cases_of(path);
    for (const auto& [key, rows] : cases) {
      const rods::RodSettings chosen = rods::default_settings(kind_of(rows[0]));
      const std::string option = std::string("direct ") + name_of(chosen.start);
      const auto own =
          std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.option() == option; });
      REQUIRE(own != rows.end());
      for (const Row& row : rows) {
        const double ratio = own->number("us_a_strand") / row.number("us_a_strand");
        if (!(std::isfinite(ratio) && ratio > 0)) continue;
        others[row.option()].own_over_other += std::log(ratio);
        ++others[row.option()].cases;
      }
    }
    for (const auto& [option, both] : others) {
      INFO(path.filename().string() << " with " << option << ", " << both.cases << " cases");
      if (2 * both.cases >= static_cast<int>(cases.size()))
        CHECK(std::exp(both.own_over_other / both.cases) <= kOfAScene);
    }
  }
}

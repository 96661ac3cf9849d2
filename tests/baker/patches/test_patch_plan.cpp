// test_patch_plan.cpp  Plans of bodies, and what is refused of them.
#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/patches/patch_plan.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew;
using Catch::Contains;

namespace {

const std::string kGood =
    R"("shape": "ear", "split": "train", "size_cells": [3, 5], "stiffness": [1, 100], "runs": 4)";

std::string refusal(const std::string& text) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("plan.json");
  baker::write_file(path, text);
  try {
    baker::read_patch_plan(path);
  } catch (const baker::BadInput& error) {
    CHECK_THAT(error.what(), Contains(path) && !Contains("\n"));
    return error.what();
  }
  return "";
}

std::string line(const std::string& keys) { return R"({"runs": [{)" + keys + "}]}"; }

std::string with(const std::string& from, const std::string& to) {
  std::string keys = kGood;
  keys.replace(keys.find(from), from.size(), to);
  return line(keys);
}

}  // namespace

TEST_CASE("patch_plans_that_ask_for_nothing_that_can_be_made_are_refused_by_key") {
  CHECK_THAT(refusal("{"), Contains("not JSON"));
  CHECK_THAT(refusal("{}"), Contains("asks for nothing"));
  CHECK_THAT(refusal(R"({"rate_hz": 0, "runs": []})"), Contains("\"rate_hz\" is 0"));
  CHECK_THAT(refusal(R"({"substeps": 0, "runs": []})"), Contains("\"substeps\" is 0"));
  CHECK_THAT(refusal(with("ear", "cube")), Contains("\"shape\" is none of sphere, cylinder"));
  CHECK_THAT(refusal(with("train", "all")), Contains("\"split\" is none of"));
  CHECK_THAT(refusal(with("[3, 5]", "[5, 3]")), Contains("\"size_cells\" has its larger number first"));
  CHECK_THAT(refusal(with("[3, 5]", "[1, 3]")), Contains("\"size_cells\""));
  CHECK_THAT(refusal(with("[1, 100]", "[0, 100]")), Contains("\"stiffness\""));
  CHECK_THAT(refusal(with("\"runs\": 4", "\"runs\": 1.5")), Contains("\"runs\" is no whole number"));
  CHECK_THAT(refusal(with("\"runs\": 4", "\"run\": 4")), Contains("run"));
  CHECK(refusal(line(kGood)).empty());
}

TEST_CASE("a_patch_plan_that_would_train_on_what_it_holds_out_is_refused") {
  std::string test = kGood;
  test.replace(test.find("train"), 5, "test");
  const auto both = [&](const std::string& seed) {
    return R"({"runs": [{)" + kGood + "}, {" + test + R"(, "first_seed": )" + seed + "}]}";
  };
  CHECK_THAT(refusal(both("4")), Contains("runs[1] shares seeds with runs[0]"));
  CHECK(refusal(both("5")).empty());
}

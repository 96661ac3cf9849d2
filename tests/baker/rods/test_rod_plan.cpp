// test_rod_plan.cpp  Plans of rods, and what is refused of them.
#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/rods/rod_plan.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew;
using Catch::Contains;

namespace {

const std::string kGood =
    R"("scene": "helix", "split": "train", "segments": [10, 20], "young_pa": [1e4, 1e6], "runs": 4)";

std::string refusal(const std::string& text) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("plan.json");
  baker::write_file(path, text);
  try {
    baker::read_rod_plan(path);
  } catch (const baker::BadInput& error) {
    CHECK_THAT(error.what(), Contains(path));
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

TEST_CASE("rod_plans_that_ask_for_nothing_that_can_be_made_are_refused_by_key") {
  CHECK_THAT(refusal("{"), Contains("not JSON"));
  CHECK_THAT(refusal("{}"), Contains("asks for nothing"));
  CHECK_THAT(refusal(R"({"dt_s": 0, "runs": []})"), Contains("\"dt_s\" is 0"));
  CHECK_THAT(refusal(with("helix", "knot")), Contains("scene 'knot' is none of"));
  CHECK_THAT(refusal(with("train", "all")), Contains("\"split\" is none of"));
  CHECK_THAT(refusal(with("[10, 20]", "[20, 10]")), Contains("\"segments\" has its larger number first"));
  CHECK_THAT(refusal(with("[10, 20]", "[1, 10]")), Contains("\"segments\""));
  CHECK_THAT(refusal(with("[1e4, 1e6]", "[0, 1e6]")), Contains("\"young_pa\""));
  CHECK_THAT(refusal(with("\"runs\": 4", "\"runs\": 0")), Contains("\"runs\" is 0"));
  CHECK_THAT(refusal(with("\"runs\": 4", "\"runs\": 1.5")), Contains("\"runs\" is no whole number"));
  CHECK_THAT(refusal(with("\"runs\": 4", "\"rods\": 4")), Contains("\"rods\" must be above 1 in a tree"));
  CHECK_THAT(refusal(with("\"runs\": 4", "\"run\": 4")), Contains("run"));
  CHECK(refusal(line(kGood)).empty());
}

TEST_CASE("a_rod_plan_that_would_train_on_what_it_holds_out_is_refused") {
  std::string test = kGood;
  test.replace(test.find("train"), 5, "test");
  const auto both = [&](const std::string& seed) {
    return refusal(R"({"runs": [{)" + kGood + "}, {" + test + R"(, "first_seed": )" + seed + "}]}");
  };
  CHECK_THAT(both("4"), Contains("runs[1] shares seeds with runs[0]"));
  CHECK(both("5").empty());
}

TEST_CASE("the_plan_in_the_tree_is_good_and_holds_out_as_much_as_the_paper") {
  const baker::RodPlan plan = baker::read_rod_plan(SINEW_SOURCE_DIR "/assets/rods/plan.json");
  const auto runs = [&](const std::string& scene, const std::string& split) {
    uint32_t sum = 0;
    for (const baker::RodLine& line : plan.lines)
      sum += line.scene == scene && line.split == split ? line.runs : 0;
    return sum;
  };
  for (const char* scene : {"bending_rod", "helix"}) {
    CHECK(runs(scene, "train") == 256);
    CHECK(runs(scene, "test") == 100);
  }
}

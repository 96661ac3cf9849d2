// joint_names.cpp  Bones of one name are told apart by their paths.
#include "baker/mesh/anatomy/joint_names.hpp"

#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "figure.hpp"

using namespace sinew::baker;

namespace {

// root > head > ear, ear; root > tail > tip; head > tip
Character character() {
  Figure figure("beast");
  const int root = figure.joint("root", -1, {0, 0, 0}), head = figure.joint("head", root, {0, 1, 0});
  figure.joint("ear", head, {0.1, 1.1, 0});
  figure.joint("ear", head, {-0.1, 1.1, 0});
  const int tail = figure.joint("tail", root, {0, 0, -1});
  figure.joint("tip", tail, {0, 0, -2});
  figure.joint("tip", head, {0, 1, 1});
  return figure.character;
}

}  // namespace

TEST_CASE("names_of_no_bone_or_of_several_are_refused") {
  const Character beast = character();
  CHECK_THROWS_WITH(find_joint(beast, "hed", "recipe: rod"), Catch::Contains("the nearest is 'head'"));
  CHECK_THROWS_WITH(find_joint(beast, "ear", "recipe: rod"),
                    Catch::Contains("'/root/head/ear#1'") && Catch::Contains("'/root/head/ear#2'"));
  CHECK_THROWS_WITH(find_joint(beast, "tip", "recipe: rod"), Catch::Contains("say 'tail/tip' or 'head/tip'"));
  CHECK_THROWS_WITH(find_joint(beast, "head/ear", "recipe: rod"), Catch::Contains("'ear#1' or 'ear#2'"));
  CHECK_THROWS_AS(find_joint(beast, "ear#3", "recipe: rod"), BadInput);
}

TEST_CASE("a_name_an_end_of_a_path_and_a_whole_path_are_one_bone_s") {
  const Character beast = character();
  CHECK(find_joint(beast, "tail", "") == 4);
  CHECK(find_joint(beast, "ear#2", "") == 3);
  CHECK(find_joint(beast, "head/ear#1", "") == 2);
  CHECK(find_joint(beast, "root/head/tip", "") == 6);
  const JointNames names(beast);
  CHECK(names.unique(1) == "head");
  CHECK(names.unique(3) == "ear#2");
  CHECK(names.unique(5) == "tail/tip");
  CHECK(match_joints(beast, {"ear"}, "") == std::vector<bool>{false, false, true, true, false, false, false});
}

TEST_CASE("a_path_that_is_the_end_of_another_begins_with_a_slash") {
  Figure figure("twins");
  const int head = figure.joint("head", -1, {0, 1, 0});
  figure.joint("ear", head, {0.1, 1.1, 0});
  const int body = figure.joint("body", -1, {0, 0, 0}), other = figure.joint("head", body, {0, 1, 1});
  figure.joint("ear", other, {0.1, 1.1, 1});
  const JointNames names(figure.character);
  CHECK(names.unique(1) == "/head/ear");
  CHECK(names.unique(4) == "body/head/ear");
  CHECK(find_joint(figure.character, "/head/ear", "") == 1);
}

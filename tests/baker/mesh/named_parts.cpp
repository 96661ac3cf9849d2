// named_parts.cpp  Characters of many kinds, of which names say what swings, and recipes that say otherwise.
#include "baker/mesh/parts/named_parts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "baker/common/bad_input.hpp"
#include "baker/import/import_gltf.hpp"
#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "column.hpp"
#include "figure.hpp"

using namespace sinew::baker;
using Catch::Contains;
using Names = std::set<std::string>;

namespace {

Names rods_of(const TissueLayout& layout) {
  Names names;
  for (const Rod& rod : layout.rods) names.insert(rod.name);
  return names;
}

Names regions_of(const TissueLayout& layout) {
  Names names;
  for (const Region& region : layout.regions) names.insert(region.name);
  return names;
}

const Rod& rod_called(const TissueLayout& layout, const std::string& name) {
  return *std::ranges::find(layout.rods, name, &Rod::name);
}

// Why a part stays rigid; empty: it is not listed.
std::string why(const TissueLayout& layout, const std::string& part) {
  const auto found = std::ranges::find(layout.skipped, part, &SkippedPart::part);
  return found == layout.skipped.end() ? "" : found->why;
}

bool noted(const Character& character, const std::string& text) {
  return std::ranges::any_of(character.notes,
                             [&](const auto& note) { return note.find(text) != std::string::npos; });
}

std::string refusal(Character character, const Recipe& recipe) {
  try {
    layout_tissue(character, recipe);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "laid out";
}

Recipe with_regions(std::vector<RegionRecipe> regions) {
  Recipe recipe;
  recipe.states_regions = true;
  recipe.regions = std::move(regions);
  return recipe;
}

struct Human {
  Figure figure;
  int pelvis, spine, chest, head;
};

// 1.8 m high: a trunk on three bones, a head, arms and legs. `spine` is the name of the middle bone.
Human human(const std::string& spine, double belly_radius) {
  Human body{Figure("human"), 0, 0, 0, 0};
  Figure& f = body.figure;
  body.pelvis = f.joint("pelvis", -1, {0, 0.9, 0});
  body.spine = f.joint(spine, body.pelvis, {0, 1.1, 0});
  body.chest = f.joint("chest", body.spine, {0, 1.3, 0});
  body.head = f.joint("head", body.chest, {0, 1.55, 0});
  f.tube({body.pelvis, body.spine, body.chest}, {0, 1.5, 0}, belly_radius);
  f.tube({body.chest, body.head}, {0, 1.8, 0}, 0.1);
  for (const double side : {-1.0, 1.0}) {
    const std::string end = side > 0 ? "_l" : "_r";
    const int thigh = f.joint("thigh" + end, body.pelvis, {0.12 * side, 0.9, 0});
    const int calf = f.joint("calf" + end, thigh, {0.12 * side, 0.5, 0});
    f.tube({thigh, calf}, {0.12 * side, 0, 0}, 0.09);
    const int arm = f.joint("upperarm" + end, body.chest, {0.2 * side, 1.45, 0});
    const int hand = f.joint("hand" + end, arm, {0.6 * side, 1.45, 0});
    f.tube({arm, hand}, {0.8 * side, 1.45, 0}, 0.05);
  }
  return body;
}

}  // namespace

TEST_CASE("regions_of_a_recipe_that_leave_nothing_soft_are_refused_with_the_reason") {
  Figure figure = human("spine_01", 0.13).figure;
  const int idle = figure.joint("idle", 0, {0, 1, 0});
  CHECK(idle > 0);
  const Character body = figure.character;
  CHECK_THAT(refusal(body, with_regions({{"belly", {"idle"}}})),
             Contains("region 'belly': nothing is soft") && Contains("name bones that move soft tissue"));
  CHECK_THAT(refusal(body, with_regions({{"belly", {"spine_01"}, 1}})), Contains("make it softer"));
  Character chain = column();
  Recipe both = with_regions({{"end", {"bone_3"}}});
  both.rods = {RodRecipe{.name = "rod", .root = "bone_2", .end = ""}};
  CHECK_THAT(refusal(chain, both), Contains("region 'end': nothing is soft: rods move its bones"));
}

TEST_CASE("a_figure_of_plain_bones_stays_rigid_and_a_note_says_how_to_change_that") {
  Character body = human("spine_01", 0.2).figure.character;
  const TissueLayout layout = layout_tissue(body, {});
  CHECK(layout.regions.empty());
  CHECK(layout.rods.empty());
  CHECK(layout.skipped.empty());
  CHECK(noted(body, "nothing swings"));
  CHECK(noted(body, "in doubt are belly, glute, thigh: sinew-bake propose"));
  CHECK_FALSE(noted(body, "head"));
  CHECK(*std::ranges::min_element(layout.stiffness) == 1);
}

TEST_CASE("breast_bones_that_share_their_flesh_with_the_chest_become_regions_of_their_name") {
  Human body = human("spine_01", 0.13);
  const int left = body.figure.joint("breast_l", body.chest, {0.08, 1.35, 0.12}),
            right = body.figure.joint("breast_r", body.chest, {-0.08, 1.35, 0.12});
  body.figure.bulge(left, body.chest, 0.07);
  body.figure.bulge(right, body.chest, 0.07);
  Character character = body.figure.character;
  const TissueLayout layout = layout_tissue(character, {});
  CHECK(regions_of(layout) == Names{"breast_l", "breast_r"});
  for (const Region& region : layout.regions) {
    CHECK(region.kind == SoftKind::kBreast);
    CHECK(region.evidence == Evidence::kBoneName);
    CHECK(region.frequency_hz == Approx(default_frequency_hz(SoftKind::kBreast, 2 * region.radius_m)));
    CHECK(region.radius_m > 0.03);
    CHECK(joint_name(character, static_cast<size_t>(region.frame_joint)) == "chest");
  }
  CHECK(layout.coreless[static_cast<size_t>(left)]);
  CHECK_FALSE(layout.coreless[static_cast<size_t>(body.chest)]);

  Character again = body.figure.character;  // the same as a recipe states it
  const TissueLayout stated =
      layout_tissue(again, with_regions({{"bosom", {"breast_l", "breast_r"}, 0.3}, {"tum", {"spine_01"}}}));
  CHECK(regions_of(stated) == Names{"bosom_l", "bosom_r", "tum"});
  CHECK(std::ranges::find(stated.regions, "bosom_l", &Region::name)->kind == SoftKind::kBreast);
  CHECK(std::ranges::find(stated.regions, "bosom_l", &Region::name)->evidence == Evidence::kRecipe);
  double softest = 1;
  for (const Region& region : stated.regions)
    for (const int v : region.vertices)
      if (region.name == "bosom_l") softest = std::min(softest, stated.stiffness[static_cast<size_t>(v)]);
  CHECK(softest == Approx(0.3));
}

TEST_CASE("a_belly_bone_of_the_spine_is_soft_where_its_flesh_is_thick") {
  Character heavy = human("belly", 0.2).figure.character, lean = human("belly", 0.1).figure.character;
  CHECK(regions_of(layout_tissue(heavy, {})) == Names{"belly"});
  const TissueLayout thin = layout_tissue(lean, {});
  CHECK(thin.regions.empty());
  CHECK_THAT(why(thin, "belly"), Contains("a lean spine bone") && Contains("5.6 %"));
}

TEST_CASE("an_empty_list_means_none") {
  Human body = human("belly", 0.2);
  body.figure.tube(body.figure.chain("tail", body.pelvis, {0, 0.9, -0.2}, {0, 0, -0.1}, 4), {0, 0.9, -0.6},
                   0.04);
  Character character = body.figure.character;
  Recipe recipe;
  CHECK(regions_of(layout_tissue(character, recipe)) == Names{"belly"});
  CHECK(rods_of(layout_tissue(character, recipe)) == Names{"tail1"});
  recipe.states_regions = true;
  CHECK(layout_tissue(character, recipe).regions.empty());
  CHECK(rods_of(layout_tissue(character, recipe)) == Names{"tail1"});
  recipe.rods.emplace();
  character.notes.clear();
  CHECK(layout_tissue(character, recipe).rods.empty());
  CHECK_FALSE(noted(character, "nothing swings"));  // it was asked for
  recipe.states_regions = false;
  const TissueLayout tissue = layout_tissue(character, recipe);
  CHECK(regions_of(tissue) == Names{"belly"});
  CHECK(tissue.rods.empty());
  Character painted = column();
  painted.stiffness.assign(painted.positions.size(), 0.1);
  for (size_t v = 0; v < 200; ++v) painted.stiffness[v] = 1;
  CHECK(layout_tissue(painted, {}).regions.size() == 1);
  CHECK(layout_tissue(painted, with_regions({})).regions.empty());
}

TEST_CASE("a_recipe_for_rods_leaves_regions_to_evidence_and_the_other_way_round") {
  Human body = human("belly", 0.2);
  const std::vector<int> tail = body.figure.chain("tail", body.pelvis, {0, 0.9, -0.2}, {0, 0, -0.1}, 4);
  body.figure.tube(tail, {0, 0.9, -0.6}, 0.04);
  Character character = body.figure.character;
  Recipe recipe;
  recipe.rods = {RodRecipe{.name = "mine", .root = "tail2", .end = ""}};
  CHECK(rods_of(layout_tissue(character, recipe)) == Names{"mine"});
  CHECK(regions_of(layout_tissue(character, recipe)) == Names{"belly"});
  const TissueLayout other = layout_tissue(character, with_regions({{"legs", {"thigh_*"}}}));
  CHECK(rods_of(other) == Names{"tail1"});
  CHECK(regions_of(other) == Names{"legs_l", "legs_r"});
  // A bone that a region names is no rod's.
  CHECK(layout_tissue(character, with_regions({{"tail", {"tail*"}}})).rods.empty());
}

TEST_CASE("a_region_of_the_recipe_and_paint_come_before_spring_bones_and_names") {
  Human body = human("spine_01", 0.2);
  const std::vector<int> tail = body.figure.chain("tail", body.pelvis, {0, 0.9, -0.2}, {0, 0, -0.1}, 4);
  body.figure.tube(tail, {0, 0.9, -0.6}, 0.04);
  Character character = body.figure.character;
  character.springs = {{.name = "tail", .root = tail[0]}};
  CHECK(layout_tissue(character, {}).rods.at(0).evidence == Evidence::kSpringBone);
  const TissueLayout stated = layout_tissue(character, with_regions({{"tail", {"tail*"}}}));
  CHECK(stated.rods.empty());
  CHECK_THAT(why(stated, "tail1"), Contains("in a soft region"));
  Character painted = character;
  for (const Influences& skin : painted.skin) painted.stiffness.push_back(skin.joint[0] >= tail[0] ? 0.1 : 1);
  const TissueLayout paint = layout_tissue(painted, {});
  CHECK(paint.rods.empty());
  REQUIRE(paint.regions.size() == 1);
  CHECK(paint.regions[0].evidence == Evidence::kPainted);
  CHECK(paint.regions[0].kind == SoftKind::kTail);
}

TEST_CASE("fins_of_a_koi_swing_on_chains_and_stay_rigid_on_one_bone") {
  Figure koi("koi");
  const int root = koi.joint("root", -1, {0, 0.3, 0});
  const int head = koi.joint("head", root, {0, 0.3, 0.2});
  const std::vector<int> body = koi.chain("body", root, {0, 0.3, -0.1}, {0, 0, -0.1}, 2);
  koi.tube({head, root, body[0], body[1]}, {0, 0.3, -0.3}, 0.1);
  const std::vector<int> left = koi.chain("pectoral_fin_L", root, {0.1, 0.3, 0.1}, {0.05, -0.02, 0}, 3);
  koi.sheet(left, {0.25, 0.24, 0.1}, {0, 0, 0.05});
  const int dorsal = koi.joint("DorsalFin", root, {0, 0.4, 0});
  koi.sheet({root, dorsal}, {0, 0.55, 0}, {0, 0, 0.05});
  const TissueLayout layout = layout_tissue(koi.character, {});
  CHECK(layout.regions.empty());
  CHECK(rods_of(layout) == Names{"pectoral_fin_L1"});
  CHECK(layout.rods[0].kind == SoftKind::kFin);
  CHECK_THAT(why(layout, "DorsalFin"), Contains("give it a chain of bones"));
}

TEST_CASE("a_robot_s_antenna_swings_and_its_sword_does_not") {
  Human robot = human("spine_01", 0.15);
  Figure& f = robot.figure;
  const std::vector<int> antenna = f.chain("Antenna", robot.head, {0, 1.8, 0}, {0, 0.1, 0}, 3);
  for (const int joint : antenna) f.tube({joint}, f.place(joint) + Vector3(0, 0.08, 0), 0.01);
  const int hand = 7;
  REQUIRE(joint_name(f.character, static_cast<size_t>(hand)) == "hand_r");
  const int sword = f.joint("sword", hand, {-0.8, 1.45, 0}), tip = f.joint("sword_fin", sword, {-0.8, 2, 0});
  f.tube({sword, tip}, {-0.8, 2.4, 0}, 0.02);
  const TissueLayout layout = layout_tissue(f.character, {});
  CHECK(layout.regions.empty());
  CHECK(rods_of(layout) == Names{"Antenna1"});
  CHECK_FALSE(why(layout, "sword_fin").empty());  // one bone and no end
}

TEST_CASE("a_snake_that_is_all_tail_is_a_body") {
  Figure snake("snake");
  const int root = snake.joint("root", -1, {0, 0.1, 0});
  const int head = snake.joint("head", root, {0, 0.1, 0.1});
  const int jaw = snake.joint("jaw", head, {0, 0.08, 0.15});
  snake.tube({root, head, jaw}, {0, 0.1, 0.3}, 0.05);
  const std::vector<int> tail = snake.chain("tail_", root, {0, 0.1, -0.1}, {0, 0, -0.2}, 6);
  for (size_t i = 0; i + 1 < tail.size(); ++i)
    snake.tube({tail[i], tail[i + 1]}, snake.place(tail[i + 1]) - Vector3(0, 0, 0.2), 0.05);
  const TissueLayout layout = layout_tissue(snake.character, {});
  CHECK(layout.regions.empty());
  CHECK(layout.rods.empty());
  CHECK_THAT(why(layout, "tail_1"), Contains("more than half of the character"));
}

TEST_CASE("a_knight_s_capes_on_one_bone_swing_and_its_helmet_does_not") {
  Human knight = human("spine_01", 0.15);
  Figure& f = knight.figure;
  f.mesh("Knight_Body", true);
  const int back = f.joint("cape", knight.chest, {0, 1.4, -0.2});
  f.sheet({back}, {0, 0.5, -0.3}, {0.3, 0, 0});
  f.mesh("Knight_Cape", true);
  f.tube({knight.head}, {0, 1.9, 0}, 0.12);
  f.mesh("Helmet", false);
  f.sheet({knight.chest}, {0, 0.7, -0.3}, {0.3, 0, 0});
  f.mesh("Second_Cloak", false);
  const TissueLayout layout = layout_tissue(f.character, {});
  CHECK(layout.rods.empty());
  CHECK(regions_of(layout) == Names{"Knight_Cape", "Second_Cloak"});
  for (const Region& region : layout.regions) {
    CHECK(region.evidence == Evidence::kMeshName);
    CHECK(region.kind == SoftKind::kCloth);
  }
  CHECK(why(layout, "cape").empty());  // it swings, though not by its bone's name
  CHECK_THAT(why(layout, "Helmet"), Contains("fastened to one bone"));

  const TissueLayout told = layout_tissue(f.character, with_regions({}));
  CHECK(told.regions.empty());
  CHECK_THAT(why(told, "Second_Cloak"), Contains("hangs on one bone, 'chest'"));

  f.end_site(back, {0, -0.9, -0.1});  // with an end its bone is a rod, which comes before its mesh
  const TissueLayout chained = layout_tissue(f.character, {});
  CHECK(rods_of(chained) == Names{"cape"});
  CHECK(regions_of(chained) == Names{"Second_Cloak"});
}

TEST_CASE("an_armoured_knight_and_a_robot_stay_rigid") {
  Human knight = human("spine_01", 0.15);
  Figure& f = knight.figure;
  f.mesh("Knight_Body", true);
  const std::vector<const char*> hard = {"Helmet", "Helmet_Horn", "Cape_Clip", "Shield",
                                         "Sword",  "Skirt_Armor", "Hat_Pin"};
  for (const char* name : hard) {  // all stick out of the chest as far as a cape does
    f.sheet({knight.chest}, {0, 0.6, -0.6}, {0.2, 0, 0});
    f.mesh(name, false);
  }
  f.tube({knight.head}, {0, 1.78, 0}, 0.105);
  f.mesh("Hood", false);  // it lies close
  const TissueLayout layout = layout_tissue(f.character, {});
  CHECK(layout.regions.empty());
  CHECK(layout.rods.empty());
  CHECK_THAT(why(layout, "Hood"), Contains("sticks out of the soft tissue of 'head'"));
  CHECK(noted(f.character, "nothing swings"));

  Human robot = human("spine_01", 0.15);
  robot.figure.mesh("Hull", true);
  robot.figure.tube({robot.head}, {0, 2.4, 0}, 0.02);
  robot.figure.mesh("Rod", false);  // no name of anything soft: metal for all that geometry knows
  CHECK(layout_tissue(robot.figure.character, {}).regions.empty());
}

TEST_CASE("a_longer_tail_swings_slower_and_legs_never_do") {
  for (const double scale : {0.1, 1.0, 8.0}) {
    Figure dinosaur("dinosaur");
    const int hips = dinosaur.joint("hips", -1, scale * Vector3(0, 1, 0));
    const int spine = dinosaur.joint("spine", hips, scale * Vector3(0, 1.1, 0.5));
    const int head = dinosaur.joint("head", spine, scale * Vector3(0, 1.4, 0.9));
    dinosaur.tube({hips, spine, head}, scale * Vector3(0, 1.4, 1.2), scale * 0.25);
    const int thigh = dinosaur.joint("thigh.L", hips, scale * Vector3(0.2, 0.9, 0));
    const int foot = dinosaur.joint("foot.L", thigh, scale * Vector3(0.2, 0.3, 0));
    dinosaur.tube({thigh, foot}, scale * Vector3(0.2, 0, 0), scale * 0.15);
    const auto tail =
        dinosaur.chain("Tail", hips, scale * Vector3(0, 1, -0.2), scale * Vector3(0, 0, -0.3), 5);
    dinosaur.tube(tail, scale * Vector3(0, 1, -1.7), scale * 0.1);
    const TissueLayout layout = layout_tissue(dinosaur.character, {});
    CHECK(layout.regions.empty());
    REQUIRE(rods_of(layout) == Names{"Tail1"});
    const Rod& rod = layout.rods[0];
    CHECK(rod.frequency_hz == Approx(default_frequency_hz(SoftKind::kTail, 1.5 * scale)).epsilon(1e-3));
    // Damping of the slowest swing: damping_s w / 2.
    CHECK(rod.bones[0].damping_s * 2 * M_PI * rod.frequency_hz / 2 == Approx(0.5).epsilon(1e-3));
  }
}

TEST_CASE("a_horse_s_mane_and_tail_swing_and_bones_that_carry_a_limb_do_not") {
  Figure horse("horse");
  const int root = horse.joint("root", -1, {0, 1.2, 0});
  const int haunch =
      horse.joint("ButtL", root, {0.2, 1.2, -0.5});  // named for its place: the leg hangs on it
  const int foot = horse.joint("hoofL", haunch, {0.2, 0.3, -0.5});
  horse.tube({root, haunch, foot}, {0.2, 0, -0.5}, 0.12);
  const int neck = horse.joint("neck", root, {0, 1.5, 0.6}), head = horse.joint("head", neck, {0, 2, 1});
  horse.tube({root, neck, head}, {0, 2, 1.4}, 0.2);
  const int manes = horse.joint("manes", neck, {0, 1.6, 0.5});  // moves nothing itself
  for (int lock = 0; lock < 3; ++lock) {
    const Vector3 begin(0, 1.7, 0.5 + 0.1 * lock), step(0, -0.05, -0.1);
    horse.tube(
        horse.chain("mane_" + std::string(1, static_cast<char>('a' + lock)) + "_", manes, begin, step, 3),
        begin + 3 * step, 0.03);
  }
  horse.tube(horse.chain("tail", root, {0, 1.3, -0.7}, {0, -0.15, -0.05}, 5), {0, 0.55, -0.95}, 0.05);
  const TissueLayout layout = layout_tissue(horse.character, {});
  CHECK(rods_of(layout) == Names{"mane_a_1", "mane_b_1", "mane_c_1", "tail1"});
  CHECK(layout.regions.empty());
  CHECK_THAT(why(layout, "ButtL"), Contains("part of the body: 'hoofL' hangs on it"));
}

TEST_CASE("every_arm_of_an_octopus_is_a_rod_of_its_own") {
  Figure octopus("octopus");
  const int head = octopus.joint("head", -1, {0, 1, 0}), top = octopus.joint("mantle_top", head, {0, 1.2, 0});
  octopus.tube({head, top}, {0, 1.5, 0}, 0.3);
  const int arms = octopus.joint("tentacles", head, {0, 0.9, 0});
  for (int arm = 0; arm < 8; ++arm) {
    const double angle = arm * M_PI / 4;
    const Vector3 out(std::cos(angle), -0.2, std::sin(angle));
    const std::string name = "tentacle_" + std::string(1, static_cast<char>('a' + arm)) + "_";
    octopus.tube(octopus.chain(name, arms, Vector3(0, 0.9, 0) + 0.3 * out, 0.2 * out, 4),
                 Vector3(0, 0.9, 0) + 1.1 * out, 0.05);
  }
  const TissueLayout layout = layout_tissue(octopus.character, {});
  CHECK(layout.rods.size() == 8);
  CHECK(layout.regions.empty());
  CHECK(rod_called(layout, "tentacle_a_1").kind == SoftKind::kTentacle);
}

TEST_CASE("an_elephant_s_trunk_swings_and_a_torso_of_that_name_does_not") {
  Figure elephant("elephant");
  const int body = elephant.joint("trunk", -1, {0, 2, 0}),
            chest = elephant.joint("trunk_upper", body, {0, 2, 0.8});
  const int head = elephant.joint("head", chest, {0, 2.5, 1.5});
  elephant.tube({body, chest, head}, {0, 2.5, 2}, 0.5);
  elephant.tube(elephant.chain("trunk_", head, {0, 2.3, 2.1}, {0, -0.4, 0.05}, 5), {0, 0.3, 2.35}, 0.12);
  const TissueLayout layout = layout_tissue(elephant.character, {});
  CHECK(rods_of(layout) == Names{"trunk_1"});
  Figure tree("tree");
  const int ground = tree.joint("root", -1, {0, 0, 0});
  tree.tube({ground, tree.joint("roots", ground, {0, 0, 1})}, {0, 0, 3}, 0.3);
  tree.tube(tree.chain("trunk_", ground, {0, 0, 0}, {0, 1, 0}, 3), {0, 3, 0}, 0.2);
  CHECK(layout_tissue(tree.character, {}).rods.empty());
}

TEST_CASE("a_tail_of_one_bone_is_flesh_and_one_that_nobody_would_see_is_nothing") {
  Human body = human("spine_01", 0.15);
  const int tail = body.figure.joint("tail", body.pelvis, {0, 0.9, -0.3});
  body.figure.tube({body.pelvis, tail}, {0, 0.9, -0.6}, 0.08);
  const int ear = body.figure.joint("ear", body.head, {0.1, 1.7, 0});
  body.figure.tube({body.head, ear}, {0.12, 1.7, 0}, 0.01);
  const TissueLayout layout = layout_tissue(body.figure.character, {});
  CHECK(layout.rods.empty());
  CHECK(regions_of(layout) == Names{"tail"});
  CHECK(layout.coreless[static_cast<size_t>(tail)]);
}

TEST_CASE("an_ear_as_thin_as_paper_on_one_bone_is_no_flesh") {
  Human body = human("spine_01", 0.15);
  const int ear = body.figure.joint("ear", body.head, {0.1, 1.75, 0});
  body.figure.sheet({body.head, ear}, {0.2, 2.1, 0}, {0, 0, 0.06});
  const TissueLayout layout = layout_tissue(body.figure.character, {});
  CHECK(layout.regions.empty());
  CHECK_THAT(why(layout, "ear"), Contains("a thin sheet"));
}

TEST_CASE("what_is_fastened_to_one_bone_is_rigid_in_a_region_that_has_flesh") {
  Human body = human("spine_01", 0.2);
  const size_t first = body.figure.character.positions.size();
  body.figure.tube({body.spine}, {0.6, 1.2, 0}, 0.1);
  Character character = body.figure.character;
  const TissueLayout layout = layout_tissue(character, with_regions({{"belly", {"spine_01"}}}));
  CHECK(regions_of(layout) == Names{"belly"});
  for (size_t v = first; v < layout.stiffness.size(); ++v) CHECK(layout.stiffness[v] == 1);
}

TEST_CASE("small_islands_of_a_stated_region_do_not_take_its_name") {
  Human body = human("spine_01", 0.2);
  const int pouch = body.figure.joint("pouch", body.spine, {0.3, 1.2, 0});
  body.figure.bulge(pouch, body.spine, 0.03);
  Character character = body.figure.character;
  const TissueLayout layout = layout_tissue(character, with_regions({{"belly", {"spine_01"}}}));
  CHECK(regions_of(layout) == Names{"belly"});
}

TEST_CASE("real_characters_swing_where_their_names_say_so") {
  if (!std::filesystem::exists(SINEW_SHARED_DIR "/characters")) {
    WARN("skipped: no characters in " SINEW_SHARED_DIR "; set SINEW_SHARED_DIR");
    return;
  }
  struct Wanted {
    const char* file;
    Names rods, regions;
  };
  const Names locks = {"HairBall_Center", "HairBall_L",         "HairBall_R",         "FrontHair_L",
                       "FrontHair_R",     "FrontHair_Center_L", "FrontHair_Center_R", "Ribbon"};
  for (const Wanted& wanted :
       {Wanted{"khronos_fox/file.glb", {"b_Tail01_012"}, {"belly"}},
        Wanted{"quaternius_wolf/file.glb", {"Tail1", "Ear1.L", "Ear1.R"}, {"belly"}},
        Wanted{"godette_vrm0/file.vrm", locks, {}},
        Wanted{"kaykit_mage/file.glb", {}, {"Mage_Cape", "Mage_Hat"}},
        Wanted{"khronos_cesium_man/file.glb", {}, {}}, Wanted{"khronos_rigged_simple/file.gltf", {}, {}},
        Wanted{"raylib_greenman/file.glb", {}, {"belly"}},
        Wanted{"mh_heavy_male/file.glb", {}, {"belly", "breast_l", "breast_r"}}}) {
    INFO(wanted.file);
    Character character = import_gltf(std::string(SINEW_SHARED_DIR "/characters/") + wanted.file);
    const TissueLayout layout = layout_tissue(character, {});
    CHECK(rods_of(layout) == wanted.rods);
    CHECK(regions_of(layout) == wanted.regions);
    CHECK(noted(character, "nothing swings") == (wanted.rods.empty() && wanted.regions.empty()));
  }
}

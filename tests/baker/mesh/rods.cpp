// rods.cpp  Bones become segments as the recipe says, and every slip names the rod and the bone.
#include "baker/mesh/rods/rods.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "baker/common/bad_input.hpp"
#include "baker/import/import_gltf.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "column.hpp"
#include "rods/section.hpp"

using namespace sinew::baker;
using Catch::Contains;

namespace {

constexpr double kRounding = 1e-12;  // a few double operations on metres

Recipe with(std::vector<RodRecipe> rods) {
  Recipe recipe;
  recipe.rods = std::move(rods);
  return recipe;
}

RodRecipe rooted(const std::string& root, const std::string& end = "") {
  RodRecipe rod;
  rod.name = rod.root = root;
  rod.end = end;
  return rod;
}

void add_joint(Character& character, const std::string& name, int parent, const Vector3& place) {
  Node node;
  node.name = name;
  node.parent = parent;
  node.translation = place;
  if (parent >= 0)
    node.translation += character.inverse_bind[static_cast<size_t>(parent)].topRightCorner<3, 1>();
  character.joint_node.push_back(static_cast<int>(character.nodes.size()));
  character.nodes.push_back(node);
  character.joint_parent.push_back(parent);
  Matrix4 bind = Matrix4::Identity();
  bind.topRightCorner<3, 1>() = -place;
  character.inverse_bind.push_back(bind);
}

std::string refusal(const Character& given, const std::vector<RodRecipe>& rods) {
  Character character = given;
  try {
    find_rods(character, with(rods));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "taken";
}

bool noted(const Character& character, const std::string& text) {
  return std::ranges::any_of(character.notes,
                             [&](const auto& note) { return note.find(text) != std::string::npos; });
}

// Newton metres a radian of the joint before a bone.
double joint_stiffness(const RodBone& parent, const RodBone& bone) {
  const auto segment = [](const RodBone& b) {
    sinew::rods::SegmentDef s;
    s.length_m = static_cast<float>((b.end - b.begin).norm());
    s.radius_m = static_cast<float>(b.radius_m);
    s.young_modulus_pa = static_cast<float>(b.young_modulus_pa);
    return s;
  };
  return 1 / sinew::rods::joint_compliance(segment(parent), segment(bone)).bend_rad_nm;
}

}  // namespace

TEST_CASE("rods_that_cannot_be_made_are_refused_with_the_rod_and_the_bone") {
  Character plain = column();
  CHECK_THAT(refusal(plain, {rooted("bone_l")}),
             Contains("recipe: rod 'bone_l': no joint is named 'bone_l'; the nearest is 'bone_"));
  CHECK_THAT(refusal(plain, {rooted("bone_1", "bone_9")}), Contains("no joint is named 'bone_9'"));
  CHECK_THAT(refusal(plain, {rooted("bone_*")}), Contains("one root"));
  CHECK_THAT(refusal(plain, {rooted("bone_0")}), Contains("'bone_0' hangs on no bone"));
  CHECK_THAT(refusal(plain, {rooted("bone_2", "bone_1")}),
             Contains("its end 'bone_1' is not below its root 'bone_2'"));
  CHECK_THAT(
      refusal(plain, {rooted("bone_3")}),
      Contains("bone 'bone_3' is alone and nothing says where it ends") && Contains("add a bone at its tip"));
  CHECK_THAT(refusal(plain, {rooted("bone_1"), rooted("bone_2")}),
             Contains("bone 'bone_2' is moved by rod 'bone_1' as well"));
  CHECK_THAT(refusal(plain, {rooted("bone_1", "bone_1"), rooted("bone_2")}),
             Contains("hangs on bone 'bone_1', which rod 'bone_1' moves"));
  CHECK_THAT(refusal(plain, {rooted("bone_2"), rooted("bone_1", "bone_1")}),
             Contains("rod 'bone_2' hangs on its bone 'bone_1'"));
  Character doubled = column();
  add_joint(doubled, "twin", 3, {0, 1.5, 0});
  CHECK_THAT(refusal(doubled, {rooted("bone_2")}),
             Contains("bones 'bone_3' and 'twin' begin at one position"));
}

TEST_CASE("a_bone_runs_to_its_child_and_the_last_one_goes_straight_on") {
  Character character = column();
  const std::vector<Rod> rods = find_rods(character, with({rooted("bone_1")}));
  REQUIRE(rods.size() == 1);
  CHECK(rods[0].name == "bone_1");
  CHECK(rods[0].attach == 0);
  REQUIRE(rods[0].bones.size() == 3);
  for (int b = 0; b < 3; ++b) {
    const RodBone& bone = rods[0].bones[static_cast<size_t>(b)];
    CHECK(bone.joint == b + 1);
    CHECK(bone.parent == b - 1);
    CHECK((bone.begin - Vector3(0, 0.5 * (b + 1), 0)).norm() < kRounding);
    CHECK((bone.end - Vector3(0, 0.5 * (b + 2), 0)).norm() < kRounding);
    CHECK(bone.radius_m == Approx(0.2).margin(0.02));  // the column's; the two ends' middles pull it down
    CHECK(bone.young_modulus_pa == RodRecipe().young_modulus_pa);
    CHECK(bone.damping_s == RodRecipe().damping_s);
  }
}

TEST_CASE("a_stated_end_ends_the_rod_and_what_hangs_below_is_carried") {
  Character character = column();
  const std::vector<Rod> rods = find_rods(character, with({rooted("bone_1", "bone_2")}));
  REQUIRE(rods[0].bones.size() == 2);
  CHECK((rods[0].bones[1].end - Vector3(0, 1.5, 0)).norm() < kRounding);  // its child's place, not a guess
  CHECK(joints_on_rods(character, rods) == std::vector<bool>{false, true, true, true});
}

TEST_CASE("an_end_site_ends_the_last_bone") {
  Character character = column();
  Node site;
  site.name = "end";
  site.parent = 3;
  site.translation = Vector3(0, 0.1, 0.2);
  character.nodes.push_back(site);
  CHECK((find_rods(character, with({rooted("bone_2")}))[0].bones[1].end - Vector3(0, 1.6, 0.2)).norm() <
        kRounding);
  Character other = column();  // the same as a joint that moves nothing
  add_joint(other, "end", 3, {0, 1.6, 0.2});
  const std::vector<Rod> rods = find_rods(other, with({rooted("bone_2")}));
  REQUIRE(rods[0].bones.size() == 2);
  CHECK((rods[0].bones[1].end - Vector3(0, 1.6, 0.2)).norm() < kRounding);
  CHECK(find_rods(other, with({rooted("bone_3")}))[0].bones.size() == 1);  // one bone, but it has an end
}

TEST_CASE("a_branch_that_begins_beside_the_end_hangs_on_a_stiff_link") {
  Character character = column();
  add_joint(character, "side", 2, {0.3, 1.2, 0});
  add_joint(character, "side_end", 4, {0.6, 1.2, 0});
  const std::vector<Rod> rods = find_rods(character, with({rooted("bone_1")}));
  const std::vector<RodBone>& bones = rods[0].bones;
  REQUIRE(bones.size() == 5);
  CHECK(bones[3].joint == -1);
  CHECK(bones[3].parent == 1);
  CHECK(bones[3].begin == bones[1].end);
  CHECK(bones[4].joint == 4);
  CHECK(bones[4].parent == 3);
  CHECK(bones[4].begin == bones[3].end);
  CHECK((bones[4].begin - Vector3(0.3, 1.2, 0)).norm() < kRounding);
  CHECK(bones[3].young_modulus_pa >= 100 * bones[4].young_modulus_pa);
}

// It begins at its parent's end, near enough, and so where it ends.
TEST_CASE("a_bone_that_snaps_to_its_own_end_is_refused") {
  Character character = column();
  add_joint(character, "second", 1, {0, 0.9997, 0});
  add_joint(character, "second_end", 4, {0, 1, 0});
  CHECK_THAT(refusal(character, {rooted("bone_1")}),
             Contains("bones 'second' and 'second_end' begin at one position"));
}

TEST_CASE("rods_come_in_the_order_of_their_roots") {
  Character character = column();
  add_joint(character, "side", 0, {0.3, 0, 0});
  add_joint(character, "side_end", 4, {0.6, 0, 0});
  const std::vector<Rod> rods = find_rods(character, with({rooted("side"), rooted("bone_1")}));
  CHECK(rods[0].name == "bone_1");
  CHECK(rods[1].name == "side");
}

TEST_CASE("a_frequency_makes_joints_that_swing_at_it") {
  constexpr double kFloat = 1e-5;  // sections are in floats
  Character character = column();
  RodRecipe recipe = rooted("bone_3");
  recipe.frequency_hz = 2;
  Character ended = column();
  add_joint(ended, "end", 3, {0, 2, 0});
  const RodBone bone = find_rods(ended, with({recipe}))[0].bones[0];
  const double l = 0.5, r = bone.radius_m, mass = 1000 * std::numbers::pi * r * r * l;
  const double inertia = mass * (3 * r * r + l * l) / 12 + mass * l * l / 4, w = 2 * std::numbers::pi * 2;
  CHECK(joint_stiffness(bone, bone) == Approx(inertia * w * w).epsilon(kFloat));
  CHECK(bone.torsion_modulus_pa == bone.young_modulus_pa);
}

TEST_CASE("a_denser_rod_swings_slower_and_loses_less_to_the_air") {
  constexpr double kFloat = 1e-5;
  const Character character = column();
  RodRecipe light = rooted("bone_1");
  light.frequency_hz = 2;
  light.drag_per_s = 0.8;
  RodRecipe heavy = light;
  heavy.density_kg_m3 = 4000;
  Character a = character, b = character;
  const Rod one = find_rods(a, with({light}))[0], other = find_rods(b, with({heavy}))[0];
  CHECK(one.frequency_hz == Approx(2).epsilon(kFloat));
  CHECK(other.frequency_hz == Approx(1).epsilon(kFloat));
  CHECK(other.bones[0].young_modulus_pa == Approx(one.bones[0].young_modulus_pa));
  CHECK(other.bones[0].density_kg_m3 == 4000);
  CHECK(one.bones[0].drag_per_s == Approx(0.8));
  CHECK(other.bones[0].drag_per_s == Approx(0.2));
}

TEST_CASE("a_damping_ratio_is_of_the_slowest_swing") {
  constexpr double kFloat = 1e-5;
  Character character = column();
  RodRecipe recipe = rooted("bone_1");
  recipe.frequency_hz = 2;
  recipe.damping_ratio = 0.25;
  CHECK(find_rods(character, with({recipe}))[0].bones[0].damping_s ==
        Approx(2 * 0.25 / (2 * std::numbers::pi * 2)).epsilon(kFloat));
  recipe.frequency_hz = 0;  // with moduli as well
  const Rod rod = find_rods(character, with({recipe}))[0];
  CHECK(rod.bones[0].damping_s == Approx(2 * 0.25 / (2 * std::numbers::pi * rod.frequency_hz)));
}

TEST_CASE("flesh_on_a_rod_is_not_soft_and_rods_alone_make_a_character") {
  Character character = column();
  Recipe recipe = with({rooted("bone_2")});
  recipe.regions = {{"all", {"bone_*"}, 0.1}};
  const TissueLayout layout = layout_tissue(character, recipe);
  REQUIRE(layout.rods.size() == 1);
  REQUIRE(!layout.regions.empty());
  for (const Region& region : layout.regions)
    for (int v : region.vertices) CHECK(character.positions[static_cast<size_t>(v)].y() < 1.0 + 0.11);
  recipe.regions.clear();
  recipe.states_regions = true;
  const TissueLayout rigid = layout_tissue(character, recipe);
  CHECK(rigid.regions.empty());
  CHECK(rigid.rods.size() == 1);
}

TEST_CASE("springs_of_the_file_become_rods_unless_the_recipe_says_otherwise") {
  Character character = column();
  character.springs = {{.name = "hair",
                        .root = 2,
                        .numbers = {.stiffness = 2,
                                    .gravity_power = 0.5,
                                    .gravity_direction = Vector3::UnitX(),
                                    .drag_force = 0.4,
                                    .hit_radius_m = 0.03},
                        .of_joints = {{3, {.stiffness = 2, .drag_force = 0.2, .hit_radius_m = 0.04}}},
                        .collider_groups = {1}},
                       {.name = "again", .root = 2},
                       {.name = "body", .root = 0}};
  Character other = character;
  const std::vector<Rod> rods = find_rods(character, {});
  REQUIRE(rods.size() == 1);  // the second is in the first, the third hangs on nothing
  CHECK(rods[0].name == "bone_2");
  CHECK(rods[0].sag == 1);
  CHECK(rods[0].gravity == Approx(40 * 0.5 / 9.80665));
  CHECK(rods[0].gravity_direction == Vector3::UnitX());
  CHECK(rods[0].collider_groups == std::vector<int>{1});
  CHECK(rods[0].bones[0].drag_per_s == Approx(60 * 0.4 / 0.6));
  CHECK(rods[0].bones[1].drag_per_s == Approx(60 * 0.2 / 0.8));  // its own number
  CHECK(rods[0].bones[0].radius_m == 0.03);
  CHECK(rods[0].bones[1].radius_m == 0.04);
  // w^2 = 60 stiffness / L of all that hangs on the last joint: its own bone.
  const RodBone& last = rods[0].bones[1];
  const double l = 0.5, r = last.radius_m, mass = 1000 * std::numbers::pi * r * r * l;
  const double inertia = mass * (3 * r * r + l * l) / 12 + mass * l * l / 4;
  CHECK(joint_stiffness(rods[0].bones[0], last) == Approx(inertia * 60 * 2 / l).epsilon(1e-4));  // floats
  CHECK(noted(character, "'bone_2' is moved by rod 'bone_2' as well; let it be in one of them: left out"));
  CHECK(noted(character, "'bone_0' hangs on no bone; name one below it: left out"));
  CHECK(noted(character, "became 1 rods"));
  CHECK(noted(character, "the file's colliders are what rods collide with"));
  CHECK(find_rods(other, with({})).empty());
  CHECK(find_rods(other, with({rooted("bone_1")}))[0].bones.size() == 3);
}

TEST_CASE("a_spring_ends_where_its_file_says") {
  Character character = column();
  add_joint(character, "side", 2, {0.3, 1, 0});
  character.springs = {{.name = "hair", .root = 1, .end = 2, .end_node = character.joint_node[4]}};
  const std::vector<Rod> rods = find_rods(character, {});
  REQUIRE(rods[0].bones.size() == 2);
  CHECK((rods[0].bones[1].end - Vector3(0.3, 1, 0)).norm() < kRounding);  // not at bone_3
  Node site;
  site.name = "far";
  for (int deep = 0; deep < 2; ++deep) {  // nodes in a row that are no joints
    site.parent = deep == 0 ? character.joint_node[3] : static_cast<int>(character.nodes.size()) - 1;
    site.translation = Vector3(0, 0.1, 0.1);
    character.nodes.push_back(site);
  }
  character.springs = {{.name = "hair", .root = 3, .end = 3, .end_node = site.parent + 1}};
  CHECK((find_rods(character, {})[0].bones[0].end - Vector3(0, 1.7, 0.2)).norm() < kRounding);
  character.springs[0].end_node = character.joint_node[3];  // its own place
  CHECK(find_rods(character, {}).empty());
  CHECK(noted(character, "bone 'bone_3' begins where it ends"));
}

TEST_CASE("a_rod_as_in_its_file_is_the_spring_that_begins_there_with_a_limit_of_the_recipe_s") {
  Character character = column();
  RodRecipe as_in_file = rooted("bone_2");
  as_in_file.as_in_file = true;
  CHECK_THAT(refusal(character, {as_in_file}),
             Contains("no spring bones of the file begin at 'bone_2'") && Contains("it has none"));
  character.springs = {{.name = "hair", .root = 1, .numbers = {.stiffness = 2, .gravity_power = 0.5}}};
  CHECK_THAT(refusal(character, {as_in_file}), Contains("they begin at bone_1"));
  as_in_file.root = as_in_file.name = "bone_1";
  as_in_file.max_displacement = 0.3;
  as_in_file.learned_start = true;
  Character other = character;
  const std::vector<Rod> stated = find_rods(character, with({as_in_file})), found = find_rods(other, {});
  REQUIRE(stated.size() == 1);
  REQUIRE(found.size() == 1);
  CHECK(stated[0].frequency_hz == found[0].frequency_hz);
  CHECK(stated[0].gravity == found[0].gravity);
  CHECK(stated[0].sag == found[0].sag);
  CHECK(stated[0].max_displacement == 0.3);
  CHECK(stated[0].states_limit);
  CHECK(stated[0].learned_start);
  CHECK_FALSE(found[0].learned_start);
}

TEST_CASE("a_lone_spring_has_a_tail_that_points_away_from_its_parent") {
  Character character = column();
  add_joint(character, "leaf", 1, {0.3, 0.5, 0.4});
  add_joint(character, "stuck", 1, {0, 0.5, 0});  // where its parent is: nothing says which way
  character.springs = {{.name = "leaf", .root = 4}, {.name = "stuck", .root = 5, .tail_m = 0.07}};
  CHECK(find_rods(character, {}).empty());
  CHECK(noted(character, "spring bone 'leaf': bone 'leaf' is alone"));  // without a tail
  CHECK(noted(character, "spring bone 'stuck': bone 'stuck' is alone"));
  character.springs[0].tail_m = 0.07;
  const std::vector<Rod> rods = find_rods(character, {});
  REQUIRE(rods.size() == 1);
  REQUIRE(rods[0].bones.size() == 1);
  CHECK((rods[0].bones[0].end - Vector3(0.342, 0.5, 0.456)).norm() < kRounding);
}

TEST_CASE("a_spring_pulls_down_no_harder_than_a_pack_may_hold") {
  Character character = column();
  character.springs = {{.name = "lead", .root = 2, .numbers = {.gravity_power = 100}}};
  CHECK(find_rods(character, {})[0].gravity == 100);  // not 40 * 100 / 9.80665
  CHECK(noted(character, "spring bone 'bone_2': its gravityPower is 407"));
  character.springs[0].numbers.gravity_power = 24;  // 97.9
  character.notes.clear();
  CHECK(find_rods(character, {})[0].gravity == Approx(40 * 24 / 9.80665));
  CHECK(!noted(character, "gravityPower"));
}

namespace {

std::vector<Rod> rods_of(const std::string& file, const Recipe& recipe, Character* out) {
  *out = import_gltf(SINEW_SHARED_DIR "/characters/" + file, {});
  return find_rods(*out, recipe);
}

bool characters_there() {
  if (std::filesystem::exists(SINEW_SHARED_DIR "/characters")) return true;
  WARN("skipped: no characters in " SINEW_SHARED_DIR "; set SINEW_SHARED_DIR");
  return false;
}

}  // namespace

TEST_CASE("tails_ears_and_hair_of_real_characters_become_rods") {
  if (!characters_there()) return;
  Character character;
  CHECK(rods_of("khronos_fox/file.glb", with({rooted("b_Tail01_012")}), &character)[0].bones.size() == 3);
  CHECK_THROWS_WITH(find_rods(character, with({rooted("Tail01")})), Contains("the nearest is 'b_"));
  const std::vector<Rod> wolf = rods_of(
      "quaternius_wolf/file.glb", with({rooted("Tail1"), rooted("Ear1.L"), rooted("Ear1.R")}), &character);
  REQUIRE(wolf.size() == 3);
  for (const Rod& rod : wolf) CHECK(rod.bones.size() == (rod.name == "Tail1" ? 8 : 4));
  const std::vector<Rod> godette = rods_of("godette_vrm0/file.vrm", {}, &character);
  CHECK(character.springs.size() == 8);
  REQUIRE(godette.size() == 8);  // four locks of the fringe, a ribbon, three buns: a bone and its end each
  for (const Rod& rod : godette) {
    INFO(rod.name);
    REQUIRE(rod.bones.size() == 1);
    CHECK(joint_name(character, static_cast<size_t>(rod.bones[0].joint)) == rod.name);
    CHECK((rod.bones[0].end - rod.bones[0].begin).norm() > 0.05);
    CHECK(rod.gravity == 0);
  }
}

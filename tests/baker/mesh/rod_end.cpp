// rod_end.cpp  Where straps are sewn on, by the recipe and by the skin.
#include "baker/mesh/rods/rod_end.hpp"

#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "column.hpp"

using namespace sinew::baker;
using Catch::Contains;

namespace {

constexpr double kRounding_m = 1e-12;  // a few double operations on metres

// The column, whose bones 1 to 3 are the strap, and a bone above it, beside the strap, that has the skin from
// `from_m` on.
Character sewn_column(double from_m = 1.8) {
  Character character = column();
  Node node;
  node.name = "buckle";
  node.parent = character.joint_node[0];
  node.translation = Vector3(0, 2, 0);
  character.joint_node.push_back(static_cast<int>(character.nodes.size()));
  character.nodes.push_back(node);
  character.joint_parent.push_back(0);
  Matrix4 bind = Matrix4::Identity();
  bind.topRightCorner<3, 1>() = Vector3(0, -2, 0);
  character.inverse_bind.push_back(bind);
  for (size_t v = 0; v < character.skin.size(); ++v) {
    if (character.positions[v].y() < from_m) continue;
    character.skin[v] = Influences();
    character.skin[v].joint[0] = 4;
    character.skin[v].weight[0] = 1;
  }
  return character;
}

RodRecipe strap(const std::string& end_joint = "") {
  RodRecipe rod;
  rod.name = rod.root = "bone_1";
  rod.end = "bone_3";
  rod.end_joint = end_joint;
  return rod;
}

std::vector<Rod> rods_of(Character& character, const std::vector<RodRecipe>& rods) {
  Recipe recipe;
  recipe.rods = rods;
  return find_rods(character, recipe);
}

std::string refusal(Character character, const std::vector<RodRecipe>& rods) {
  try {
    rods_of(character, rods);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "taken";
}

Rod only(Character character, const RodRecipe& rod) { return rods_of(character, {rod}).at(0); }

}  // namespace

TEST_CASE("an_end_joint_that_cannot_hold_a_rod_is_refused_by_name") {
  const Character character = sewn_column();
  CHECK_THAT(refusal(character, {strap("bukle")}),
             Contains("rod 'bone_1': end_joint") && Contains("'bukle'") && Contains("buckle"));
  CHECK_THAT(refusal(character, {strap("buck*")}), Contains("end_joint") && Contains("may be many"));
  CHECK_THAT(refusal(character, {strap("bone_3")}), Contains("'bone_3' is moved by a rod"));
  RodRecipe other;
  other.name = other.root = "buckle";
  CHECK_THAT(refusal(character, {strap("buckle"), other}), Contains("'buckle' is moved by a rod"));
  Character branching = character;
  branching.joint_parent[4] = 2;  // below bone_2, beside bone_3
  branching.nodes[static_cast<size_t>(branching.joint_node[4])].parent = branching.joint_node[2];
  RodRecipe tree = strap("bone_0");
  tree.end.clear();
  CHECK_THAT(refusal(branching, {tree}), Contains("it has branches"));
}

TEST_CASE("a_stated_end_joint_holds_the_end_at_its_seam_or_where_the_last_bone_ends") {
  const Rod sewn = only(sewn_column(), strap("buckle"));
  CHECK(sewn.end_joint == 4);
  CHECK((sewn.bones.back().end - Vector3(0, 1.8, 0)).norm() < kRounding_m);
  const Rod apart = only(sewn_column(3), strap("buckle"));  // no skin of its own
  CHECK(apart.end_joint == 4);
  CHECK((apart.bones.back().end - Vector3(0, 2, 0)).norm() < kRounding_m);  // straight on
}

TEST_CASE("a_rod_whose_skin_goes_on_to_another_bone_is_held_by_it_and_a_note_says_so") {
  Character character = sewn_column();
  const std::vector<Rod> rods = rods_of(character, {strap()});
  CHECK(rods.at(0).end_joint == 4);
  CHECK((rods[0].bones.back().end - Vector3(0, 1.8, 0)).norm() < kRounding_m);
  REQUIRE(character.notes.size() == 1);
  CHECK_THAT(character.notes[0], Contains("rod 'bone_1'") && Contains("bone 'buckle'") &&
                                     Contains("end_joint") && Contains("max_displacement"));
}

TEST_CASE("where_the_skin_leaves_a_doubt_or_a_limit_is_stated_an_end_is_free") {
  CHECK(only(column(), strap()).end_joint == -1);
  RodRecipe limited = strap();
  limited.max_displacement = 0.5;
  CHECK(only(sewn_column(), limited).end_joint == -1);
  RodRecipe lone = strap();
  lone.root = "bone_3";  // one bone, between that which holds it and another: a tuft on skin of two bones
  Character tuft = sewn_column();
  Node site;
  site.name = "tip";
  site.parent = tuft.joint_node[3];
  site.translation = Vector3(0, 0.3, 0);
  tuft.nodes.push_back(site);
  CHECK(only(tuft, lone).end_joint == -1);
  Character along = sewn_column();  // a fold of skin along the chain, not a seam at its end
  for (size_t v = 0; v < along.skin.size(); ++v)
    if (along.positions[v].y() > 0.6 && along.positions[v].x() > 0.05) {
      along.skin[v] = Influences();
      along.skin[v].joint[0] = 4;
      along.skin[v].weight[0] = 1;
    }
  CHECK(only(along, strap()).end_joint == -1);
  Character root = sewn_column();  // on the bone that holds the beginning: hair that is one with its head
  for (Influences& skin : root.skin)
    if (skin.joint[0] == 4) skin.joint[0] = 0;
  CHECK(only(root, strap()).end_joint == -1);
}

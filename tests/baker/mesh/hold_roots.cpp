// hold_roots.cpp  Chains that begin where the skeleton begins are held by what is above them.
#include "baker/mesh/rods/hold_roots.hpp"

#include <catch2/catch.hpp>

#include "baker/import/character/pose.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/rods/rods.hpp"
#include "figure.hpp"

using namespace sinew::baker;

namespace {

constexpr double kRounding = 1e-12;

// A lock of four bones whose first has no joint above it, at 1.5 m; `above`: below a node of that name there.
Figure lock(const std::string& bone, const std::string& above) {
  Figure figure("wig");
  const std::vector<int> bones = figure.chain(bone, -1, {0, 1.5, 0}, {0, -0.1, 0}, 4);
  figure.tube(bones, {0, 1.1, 0}, 0.03);
  if (above.empty()) return figure;
  Character& c = figure.character;  // nodes have their parents before them
  for (Node& node : c.nodes) node.parent = node.parent < 0 ? 0 : node.parent + 1;
  for (int& node : c.joint_node) ++node;
  Node head;
  head.name = above;
  head.translation = {0, 1.4, 0};
  c.nodes.insert(c.nodes.begin(), head);
  c.nodes[1].translation -= head.translation;
  return figure;
}

}  // namespace

TEST_CASE("hair_without_a_bone_above_is_held_by_the_node_above") {
  Character character = lock("hair", "head").character;
  const std::vector<Vector3> before = skin_positions(character, bind_matrices(character));
  const TissueLayout layout = layout_tissue(character, {});
  REQUIRE(layout.rods.size() == 1);
  CHECK(layout.rods[0].bones.size() == 4);
  CHECK(joint_name(character, static_cast<size_t>(layout.rods[0].attach)) == "head");
  CHECK((bind_matrices(character)[0].topRightCorner<3, 1>() - Vector3(0, 1.4, 0)).norm() < kRounding);
  const std::vector<Vector3> after = skin_positions(character, bind_matrices(character));
  for (size_t v = 0; v < before.size(); ++v) CHECK((after[v] - before[v]).norm() < kRounding);
  CHECK(character.joint_parent == std::vector<int>{-1, 0, 1, 2, 3});
}

TEST_CASE("a_chain_with_nothing_above_is_held_by_the_instance_s_root") {
  Character character = lock("whip", "").character;
  CHECK(layout_tissue(character, {}).rods.empty());  // its name says nothing
  Recipe recipe;
  RodRecipe rod;
  rod.name = "whip";
  rod.root = "whip1";
  recipe.rods = {rod};
  const TissueLayout layout = layout_tissue(character, recipe);
  REQUIRE(layout.rods.size() == 1);
  CHECK(layout.rods[0].bones.size() == 4);
  CHECK(joint_name(character, 0) == "root");
  CHECK(bind_matrices(character)[0].isIdentity(0));
}

TEST_CASE("springs_of_bones_without_a_joint_above_become_rods") {
  Character character = lock("strand", "head").character;
  character.springs = {{.name = "strand", .root = 0, .of_joints = {{1, {.stiffness = 2}}}}};
  character.colliders = {{.joint = 2, .radius_m = 0.1}};
  const TissueLayout layout = layout_tissue(character, {});
  REQUIRE(layout.rods.size() == 1);
  CHECK(layout.rods[0].bones.size() == 4);
  CHECK(character.springs[0].root == 1);
  CHECK(character.springs[0].of_joints[0].first == 2);
  CHECK(character.colliders[0].joint == 3);
}

TEST_CASE("two_chains_below_nodes_that_are_called_like_chains_are_held_alike") {
  Character character = lock("hair_r", "hair_R").character;
  const Character other = lock("hair_l", "hair_L").character;
  const auto nodes = static_cast<int>(character.nodes.size()),
             joints = static_cast<int>(character.joint_node.size());
  for (Node node : other.nodes) {
    if (node.parent >= 0) node.parent += nodes;
    character.nodes.push_back(node);
  }
  for (size_t j = 0; j < other.joint_node.size(); ++j) {
    character.joint_node.push_back(other.joint_node[j] + nodes);
    character.joint_parent.push_back(other.joint_parent[j] < 0 ? -1 : other.joint_parent[j] + joints);
    character.inverse_bind.push_back(other.inverse_bind[j]);
  }
  hold_roots(character, {});
  CHECK(character.joint_node.size() == 10);
  size_t roots = 0;
  for (size_t j = 0; j < character.joint_node.size(); ++j) {
    if (character.joint_parent[j] >= 0) continue;
    ++roots;
    CHECK(joint_name(character, j).starts_with("hair_"));
    CHECK(joint_name(character, j).size() == 6);  // the node, not a bone
  }
  CHECK(roots == 2);
}

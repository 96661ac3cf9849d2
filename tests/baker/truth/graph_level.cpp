// graph_level.cpp  Coarser graphs are those with fewer nodes.
#include "baker/truth/graph_level.hpp"

#include <catch2/catch.hpp>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/truth/tissue_truth.hpp"
#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;

namespace {

// A bar on two joints, soft about the second.
std::vector<size_t> nodes_of_levels(int finest, const std::vector<int>& coarser) {
  Character character = sinew::test::bare_character({Vector3(0, -0.45, 0), Vector3(0, 0.1, 0)});
  sinew::test::add_box(character, {-0.15, -0.5, -0.15}, {0.15, 0.5, 0.15}, 0.1, 0);
  for (size_t v = 0; v < character.positions.size(); ++v)
    if (character.positions[v].y() > 0) character.skin[v].joint[0] = 1;
  Recipe recipe;
  recipe.voxels_high = 10;
  recipe.coreless_joints = {"joint_1"};
  recipe.regions = {{"top", {"joint_1"}, 0.1}};
  recipe.states_regions = true;
  recipe.nodes_per_region = finest;
  recipe.coarser_nodes = coarser;
  const TissueLayout layout = layout_tissue(character, recipe);
  TissueTruth truth(character, layout, recipe);
  const std::vector<ModalBasis> modes = truth.modal_bases(layout, kMostModes);
  std::vector<size_t> nodes = {layout.nodes.size()};
  for (const GraphLevel& level : coarser_levels(character, recipe, truth, layout, modes))
    nodes.push_back(level.layout.nodes.size());
  return nodes;
}

}  // namespace

TEST_CASE("each_coarser_graph_has_as_many_nodes_as_the_recipe_says") {
  CHECK(nodes_of_levels(30, {20, 10}) == std::vector<size_t>{30, 20, 10});
}

TEST_CASE("a_graph_with_no_fewer_nodes_than_the_finer_one_is_left_out") {
  const std::vector<size_t> nodes = nodes_of_levels(4096, {4000, 2000, 10});
  REQUIRE(nodes.size() == 2);
  CHECK(nodes[0] < 2000);
  CHECK(nodes[1] == 10);
}

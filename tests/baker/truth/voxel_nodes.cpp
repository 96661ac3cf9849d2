// voxel_nodes.cpp  Parts that an emulator predicts stand on their voxels' corners.
#include "baker/truth/voxel_nodes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/truth/tissue_truth.hpp"
#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;
using Catch::Contains;

namespace {

// A bar on two joints, soft about the second.
struct Bar {
  Character character = sinew::test::bare_character({Vector3(0, -0.45, 0), Vector3(0, 0.1, 0)});
  Recipe recipe;
  Bar() {
    sinew::test::add_box(character, {-0.15, -0.5, -0.15}, {0.15, 0.5, 0.15}, 0.1, 0);
    for (size_t v = 0; v < character.positions.size(); ++v)
      if (character.positions[v].y() > 0) character.skin[v].joint[0] = 1;
    recipe.coreless_joints = {"joint_1"};
    recipe.regions = {{"top", {"joint_1"}, 0.1}};
    recipe.states_regions = true;
    recipe.nodes_per_region = 60;
  }
  TissueLayout layout() { return layout_to_bake(character, recipe); }
};

}  // namespace

TEST_CASE("a_part_stands_on_about_as_many_free_corners_as_the_recipe_says") {
  Bar bar;
  bar.recipe.regions[0].emulated = true;
  const TissueLayout layout = bar.layout();
  REQUIRE(bar.character.notes.size() == 1);
  CHECK_THAT(bar.character.notes[0],
             Contains("'top' has its nodes on voxels of") && Contains("free corners"));
  const Region& region = layout.regions[0];
  const auto free =
      std::ranges::count_if(layout.nodes, [](const ControlNode& n) { return !n.corner.is_held; });
  CHECK(free > 30);
  CHECK(free < 120);
  CHECK(free < region.node_count);
  CHECK(region.cell_m > 0.02);
  CHECK(region.carry.size() == layout.nodes.size());
  for (const auto& [a, b] : layout.edges) {
    const double apart =
        (layout.nodes[static_cast<size_t>(a)].position - layout.nodes[static_cast<size_t>(b)].position)
            .norm() /
        region.cell_m;
    CHECK((std::abs(apart - 1) < 1e-6 || std::abs(apart - std::sqrt(2)) < 1e-6));
  }
  for (const ControlNode& node : layout.nodes) {
    REQUIRE(node.corner.is_corner);
    CHECK(node.corner.mass > 0);
    CHECK(node.corner.mass < 2);
    CHECK(node.corner.stiffness_per_s2 > 0);
  }
}

TEST_CASE("what_no_recipe_wants_emulated_is_left_as_it_was") {
  Bar bar;
  const TissueLayout layout = bar.layout();
  CHECK(layout.nodes.size() == layout_tissue(bar.character, bar.recipe).nodes.size());
  CHECK(layout.skin_nodes.empty());
  CHECK(bar.character.notes.empty());
}

TEST_CASE("beside_an_emulated_part_the_others_keep_their_nodes") {
  Bar bar;
  bar.recipe.coreless_joints.push_back("joint_0");
  bar.recipe.regions.push_back({"foot", {"joint_0"}, 0.1});
  bar.recipe.regions[1].emulated = true;
  const TissueLayout on_skin = layout_tissue(bar.character, bar.recipe);
  REQUIRE(on_skin.regions.size() == 2);
  const size_t plain = on_skin.regions[0].emulated ? 1 : 0;
  const Region& before = on_skin.regions[plain];
  const TissueLayout layout = bar.layout();
  CHECK(layout.regions[plain].node_count == before.node_count);
  CHECK(layout.regions[plain].carry == before.carry);
  CHECK(layout.regions[plain].cell_m == 0);
  CHECK(layout.regions[1 - plain].cell_m > 0);
}

TEST_CASE("flesh_beside_an_emulated_part_keeps_its_first_frequency") {
  Bar bar;
  bar.recipe.coreless_joints.push_back("joint_0");
  bar.recipe.regions.push_back({"foot", {"joint_0"}, 0.1});
  const auto first_rad_per_s = [&] {
    const TissueLayout layout = bar.layout();
    const size_t top = layout.regions[0].name == "top" ? 0 : 1;
    return TissueTruth(bar.character, layout, bar.recipe).modal_bases(layout, 4)[top].first_rad_per_s;
  };
  const double on_skin = first_rad_per_s();
  bar.recipe.regions[1].emulated = true;
  CHECK(first_rad_per_s() == Approx(on_skin).epsilon(1e-6));
}

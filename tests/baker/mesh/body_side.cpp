// body_side.cpp  Flesh lies where anatomy and gravity put it, and its rim is wide.
#include "baker/mesh/anatomy/body_side.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/regions/rim.hpp"
#include "column.hpp"
#include "figure.hpp"

using namespace sinew::baker;

namespace {

// 0.1 is stated; in a short part with a wide rim the middle is a little stiffer.
constexpr double kSoft = 0.4;

// Legs and arms below a trunk of this radius along +Z, 1 m above the ground.
Figure four_legged(double radius) {
  Figure figure("beast");
  const int root = figure.joint("root", -1, {0, 0, 0});
  const int hips = figure.joint("hips", root, {0, 1, 0}), spine = figure.joint("spine", hips, {0, 1, 0.5}),
            chest = figure.joint("chest", spine, {0, 1, 1}), head = figure.joint("head", chest, {0, 1, 1.5});
  figure.tube({hips, spine, chest}, {0, 1, 1.5}, radius);
  figure.tube({head}, {0, 1, 1.8}, 0.1);
  for (const auto& [on, z] : {std::pair{hips, 0.1}, std::pair{chest, 1.2}})
    for (const double x : {0.2, -0.2}) {
      const int upper = figure.joint(x > 0 ? "leg.l" : "leg.r", on, {x, 0.8, z}),
                lower = figure.joint(x > 0 ? "shin.l" : "shin.r", upper, {x, 0.4, z});
      figure.tube({upper, lower}, {x, 0, z}, 0.06);
    }
  figure.mesh("beast", true);
  return figure;
}

// Its feet point along +Z, or the other way; the trunk's middle is `belly` m further out at the front.
Figure upright(double radius, double belly, double toes) {
  Figure figure("person");
  const int root = figure.joint("root", -1, {0, 0, 0});
  const int pelvis = figure.joint("pelvis", root, {0, 0.9, 0}),
            spine = figure.joint("spine", pelvis, {0, 1.1, 0}),
            chest = figure.joint("chest", spine, {0, 1.3, 0}),
            head = figure.joint("head", chest, {0, 1.5, 0});
  figure.tube({pelvis, spine, chest}, {0, 1.5, 0}, radius);
  for (Vector3& place : figure.character.positions)
    if (place.z() * toes > 0)
      place.z() *= 1 + belly / radius * std::max(0.0, 1 - std::abs(place.y() - 1.15) / 0.2);
  figure.tube({head}, {0, 1.75, 0}, 0.1);
  for (const double x : {0.1, -0.1}) {
    const int thigh = figure.joint(x > 0 ? "thigh_l" : "thigh_r", pelvis, {x, 0.85, 0}),
              foot = figure.joint(x > 0 ? "foot_l" : "foot_r", thigh, {x, 0.05, 0});
    figure.tube({thigh}, {x, 0.05, 0}, 0.06);
    figure.tube({foot}, {x, 0.02, 0.2 * toes}, 0.03);
    const int arm = figure.joint(x > 0 ? "upperarm_l" : "upperarm_r", chest, {2 * x, 1.4, 0}),
              hand = figure.joint(x > 0 ? "hand_l" : "hand_r", arm, {4 * x, 1.4, 0});
    figure.tube({arm, hand}, {6 * x, 1.4, 0}, 0.04);
  }
  figure.mesh("person", true);
  return figure;
}

Recipe belly_on(const std::vector<std::string>& joints) {
  Recipe recipe;
  recipe.states_regions = true;
  recipe.regions = {{"belly", joints, 0.1}};
  return recipe;
}

// Softest stiffness of the layout's skin on either side of y or z (axis 1, 2) = at.
std::pair<double, double> softest(const Character& character, const TissueLayout& layout, int axis,
                                  double at) {
  std::pair<double, double> softest(1, 1);
  for (size_t v = 0; v < layout.stiffness.size(); ++v) {
    double& side = character.positions[v][axis] < at ? softest.first : softest.second;
    side = std::min(side, layout.stiffness[v]);
  }
  return softest;
}

}  // namespace

TEST_CASE("the_belly_of_what_lies_is_soft_below_its_spine_and_rigid_above") {
  Character character = four_legged(0.25).character;
  const TissueLayout layout = layout_tissue(character, belly_on({"spine"}));
  const auto [below, above] = softest(character, layout, 1, 1);
  CHECK(below < kSoft);
  CHECK(above == 1);
}

TEST_CASE("the_belly_of_what_stands_is_soft_before_its_spine_wherever_its_feet_point") {
  for (const double toes : {1.0, -1.0}) {
    Character character = upright(0.15, 0, toes).character;
    const TissueLayout layout = layout_tissue(character, belly_on({"spine"}));
    const auto [minus, plus] = softest(character, layout, 2, 0);
    CHECK((toes > 0 ? plus : minus) < kSoft);
    CHECK((toes > 0 ? minus : plus) == 1);
  }
}

TEST_CASE("a_belly_is_before_the_spine_wherever_a_character_stands_and_faces") {
  const Character straight = upright(0.15, 0.15, 1).character;
  Character before = straight;
  const TissueLayout expected = layout_tissue(before, {});
  REQUIRE(expected.regions.size() == 1);
  Matrix4 aside = Matrix4::Identity(), turned = aside;
  aside(0, 3) = 3;
  turned.topLeftCorner<3, 3>() = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY()).toRotationMatrix();
  for (const Matrix4& moved : {aside, turned}) {
    Character character = straight;
    for (Vector3& place : character.positions) place = (moved * place.homogeneous()).head<3>();
    for (Vector3& normal : character.normals) normal = moved.topLeftCorner<3, 3>() * normal;
    for (Matrix4& bind : character.inverse_bind) bind = bind * moved.inverse();
    const TissueLayout layout = layout_tissue(character, {});
    for (size_t v = 0; v < layout.stiffness.size(); ++v)
      CHECK(layout.stiffness[v] == Approx(expected.stiffness[v]).margin(1e-6));  // of sums in another order
  }
}

TEST_CASE("a_limit_that_a_recipe_states_does_not_change_what_is_soft") {
  Character one = four_legged(0.25).character, other = one;
  Recipe recipe = belly_on({"spine"});
  const TissueLayout usual = layout_tissue(one, recipe);
  recipe.regions[0].max_displacement = 0.02;
  CHECK(layout_tissue(other, recipe).stiffness == usual.stiffness);
}

TEST_CASE("a_side_that_nothing_tells_is_noted") {
  Character worm = column();
  Recipe recipe = belly_on({"bone_1"});
  recipe.regions[0].side = BodySide::kFront;
  layout_tissue(worm, recipe);
  CHECK(std::ranges::any_of(worm.notes, [](const std::string& note) {
    return note.find("'belly': its side is not used: no limbs in pairs") != std::string::npos;
  }));
}

TEST_CASE("a_region_is_soft_on_the_side_that_it_states_or_all_around") {
  Character character = four_legged(0.25).character;
  Recipe recipe = belly_on({"spine"});
  recipe.regions[0].side = BodySide::kAbove;
  const auto [under, back] = softest(character, layout_tissue(character, recipe), 1, 1);
  CHECK(under == 1);
  CHECK(back < kSoft);
  recipe.regions[0].side = BodySide::kAround;
  const auto [below, above] = softest(character, layout_tissue(character, recipe), 1, 1);
  CHECK(below < kSoft);
  CHECK(above < kSoft);
}

TEST_CASE("softness_of_a_side_fades_over_a_width_that_does_not_tear_the_skin") {
  Character character = upright(0.15, 0.1, 1).character;
  const TissueLayout layout = layout_tissue(character, belly_on({"spine"}));
  REQUIRE(layout.regions.size() == 1);
  const Region& belly = layout.regions[0];
  const double wanted_m = belly.max_displacement * belly.radius_m;
  for (const auto& face : character.triangles)
    for (size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<size_t>(face[k]), b = static_cast<size_t>(face[(k + 1) % 3]);
      const double softness = std::abs(layout.stiffness[a] - layout.stiffness[b]) / 0.9;
      const double way = (character.positions[a] - character.positions[b]).norm();
      // What is shown follows softness; a quarter, and half as much again for rims that grew beyond the part
      // that the width was found for.
      CHECK(wanted_m * softness / way <= 0.25 * 1.5);
    }
}

TEST_CASE("a_rim_spreads_over_open_skin_and_falls_inwards_where_it_is_closed") {
  const Character character = column();
  const Surface surface = find_surface(character);
  std::vector<double> open, softness;
  for (const Vector3& place : character.positions) {
    open.push_back(place.y() < 0.8 ? 1 : 0);
    softness.push_back(place.y() > 0.4 && place.y() < 0.8 ? 1 : 0);
  }
  const double width_m = 0.2;
  fade_rim(character, surface, open, width_m, softness);
  for (size_t v = 0; v < softness.size(); ++v) {
    const double y = character.positions[v].y();
    if (y >= 0.8) CHECK(softness[v] == 0);
    if (y > 0.25 && y < 0.4 && character.welded[v] == static_cast<int>(v)) CHECK(softness[v] > 0);
    for (const int next : surface.neighbours[v]) {
      const double way = (character.positions[v] - character.positions[static_cast<size_t>(next)]).norm();
      CHECK(std::abs(softness[v] - softness[static_cast<size_t>(next)]) <= way / width_m + 1e-12);
    }
  }
}

TEST_CASE("without_a_recipe_only_a_belly_that_its_shape_makes_certain_is_soft") {
  const auto lay = [](Character character) { return layout_tissue(character, {}); };
  const TissueLayout beast = lay(four_legged(0.25).character);
  REQUIRE(beast.regions.size() == 1);
  CHECK(beast.regions[0].name == "belly");
  CHECK(beast.regions[0].evidence == Evidence::kShape);

  CHECK(lay(upright(0.15, 0.15, 1).character).regions.size() == 1);
  const TissueLayout lean = lay(upright(0.1, 0, 1).character);
  CHECK(lean.regions.empty());
  REQUIRE(lean.found_regions.size() == 3);  // belly, buttocks, thighs
  CHECK_THAT(lean.found_regions[0].doubt, Catch::Contains("lean"));

  Figure armoured = upright(0.15, 0.15, 1);
  armoured.character.nodes.back().name = "Knight_Body";
  const TissueLayout knight = lay(armoured.character);
  CHECK(knight.regions.empty());
  REQUIRE(!knight.found_regions.empty());
  CHECK_THAT(knight.found_regions[0].doubt, Catch::Contains("'Knight_Body' is named like something hard"));
}

TEST_CASE("what_has_no_limbs_has_no_side_and_nothing_in_doubt") {
  Character worm = column();
  const TissueLayout layout = layout_tissue(worm, {});
  CHECK(layout.regions.empty());
  CHECK(layout.found_regions.empty());
}

// pieces.cpp  Regions that name a mesh, a material or an island: a cape, a hat, a head of hair.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/surface/closest_place.hpp"
#include "figure.hpp"

using namespace sinew::baker;
using Catch::Contains;

namespace {

struct Bust {
  Figure figure{"bust"};
  int pelvis, chest, head;

  // 1.8 m high, on three bones.
  Bust() {
    pelvis = figure.joint("pelvis", -1, {0, 0.9, 0});
    chest = figure.joint("chest", pelvis, {0, 1.2, 0});
    head = figure.joint("head", chest, {0, 1.5, 0});
    figure.tube({pelvis, chest}, {0, 1.45, 0}, 0.18);
    figure.tube({pelvis}, {0, 0, 0}, 0.1);
    figure.mesh("Body", true);
    figure.tube({head}, {0, 1.8, 0}, 0.12);
    figure.mesh("Head", true);
  }

  // A joint for the shape of what is then fastened to the head.
  int mark(const Vector3& place) { return figure.joint("mark", head, place); }
  void fasten_marked() {
    const int last = head;
    for (Influences& skin : figure.character.skin)
      if (skin.joint[0] > last) skin.joint[0] = head;
  }

  // From inside the chest down to a hem behind the knees.
  void add_cape() {
    figure.sheet({chest}, {0, 0.4, -0.4}, {0.3, 0, 0});
    figure.mesh("Red_Cape", false);
  }
};

RegionRecipe mesh_region(const std::string& mesh) {
  RegionRecipe region;
  region.name = "piece";
  region.mesh = mesh;
  return region;
}

Recipe recipe_of(std::vector<RegionRecipe> regions) {
  Recipe recipe;
  recipe.states_regions = true;
  recipe.regions = std::move(regions);
  return recipe;
}

std::string refusal(Character character, const RegionRecipe& region) {
  try {
    layout_tissue(character, recipe_of({region}));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "laid out";
}

// Vertices [first, last) of a mesh.
std::pair<size_t, size_t> span_of(const Character& character, const std::string& mesh) {
  for (const MeshSpan& span : character.meshes)
    if (character.nodes[static_cast<size_t>(span.node)].name == mesh)
      return {span.first_vertex, span.first_vertex + span.vertex_count};
  FAIL("no mesh " << mesh);
  return {};
}

// Mean stiffness of a mesh's vertices in a slab of heights.
double stiffness_between(const Character& character, const TissueLayout& layout, const std::string& mesh,
                         double low, double high) {
  const auto [first, last] = span_of(character, mesh);
  double sum = 0;
  int count = 0;
  for (size_t v = first; v < last; ++v)
    if (character.positions[v].y() >= low && character.positions[v].y() <= high)
      sum += layout.stiffness[v], ++count;
  REQUIRE(count > 0);
  return sum / count;
}

bool all_rigid_but(const Character& character, const TissueLayout& layout, const std::string& mesh) {
  const auto [first, last] = span_of(character, mesh);
  for (size_t v = 0; v < layout.stiffness.size(); ++v)
    if ((v < first || v >= last) && layout.stiffness[v] < 1) return false;
  return true;
}

bool connected(const TissueLayout& layout) {
  std::set<int> reached = {0};
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto& [a, b] : layout.edges)
      if (reached.contains(a) != reached.contains(b)) reached.insert({a, b}), grows = true;
  }
  return reached.size() == layout.nodes.size();
}

}  // namespace

TEST_CASE("pieces_that_are_not_there_are_refused_with_the_names_that_are") {
  Bust bust;
  CHECK_THAT(refusal(bust.figure.character, mesh_region("Red_Cap")),
             Contains("recipe: region 'piece': no mesh is named 'Red_Cap'; there are 'Head', 'Body'"));
  bust.add_cape();
  Character& character = bust.figure.character;
  CHECK_THAT(refusal(character, mesh_region("Red_Cap")), Contains("there are 'Red_Cape', 'Head', 'Body'"));
  RegionRecipe region = mesh_region("");
  region.material = "Wool";
  CHECK_THAT(refusal(character, region), Contains("no material is named 'Wool'; the file names none"));
  character.materials = {{"Skin", {0, 1, 2}}, {"Wood", {3, 4, 5}}};
  CHECK_THAT(refusal(character, region), Contains("there are 'Wood', 'Skin'"));
  region.material = "Skin";
  region.mesh = "Head";
  CHECK_THAT(refusal(character, region), Contains("mesh 'Head' has nothing of material 'Skin'"));
  region = mesh_region("");
  region.island_at = Vector3(0, 0.4, -1.4);  // a metre behind the hem; a tenth of the height is 0.18
  CHECK_THAT(refusal(character, region), Contains("no surface within 0.18 m of island_at [0, 0.4, -1.4]") &&
                                             Contains("the nearest is 1.04 m away, at"));
  region.island_at = Vector3(0, 0.4, -0.4);
  region.joints = {"cheast"};
  CHECK_THAT(refusal(character, region), Contains("no joint is named 'cheast'; the nearest is 'chest'"));
}

TEST_CASE("a_piece_that_hardly_sticks_out_stays_rigid_with_the_reason") {
  Bust bust;
  bust.figure.tube({bust.head}, {0, 1.78, 0}, 0.125);
  bust.figure.mesh("Mask", false);
  CHECK_THAT(
      refusal(bust.figure.character, mesh_region("Mask")),
      Contains("region 'piece': nothing is soft: it sticks out") && Contains("pieces stay rigid below 10 %"));
}

TEST_CASE("a_cape_is_held_in_the_shoulders_and_softest_at_its_hem") {
  Bust bust;
  bust.add_cape();
  Character character = bust.figure.character;
  const TissueLayout layout = layout_tissue(character, recipe_of({mesh_region("Red_Cape")}));
  REQUIRE(layout.regions.size() == 1);
  const Region& region = layout.regions[0];
  CHECK(region.kind == SoftKind::kCloth);  // by the mesh's name
  CHECK(region.evidence == Evidence::kRecipe);
  CHECK(region.frame_joint == bust.chest);
  CHECK(region.damping_ratio > Recipe().damping_ratio);
  CHECK(all_rigid_but(character, layout, "Red_Cape"));
  CHECK(stiffness_between(character, layout, "Red_Cape", 1.05, 1.3) > Recipe().rigid_stiffness);
  CHECK(stiffness_between(character, layout, "Red_Cape", 0.39, 0.41) == Approx(0.1));
  double above = 1;
  for (const double y : {0.5, 0.6, 0.7, 0.8, 0.9}) {  // it hardens all the way up
    const double here = stiffness_between(character, layout, "Red_Cape", y - 0.04, y + 0.04);
    if (above < 1) CHECK(here >= above);
    above = here;
  }
  // Of a thin sheet that a region of bones names a note warns; a piece is one by nature.
  for (const std::string& note : character.notes) CHECK(note.find("thin sheet") == std::string::npos);
}

TEST_CASE("a_material_and_an_island_select_the_same_cape_as_its_mesh") {
  Bust bust;
  bust.add_cape();
  Character character = bust.figure.character;
  const TissueLayout by_mesh = layout_tissue(character, recipe_of({mesh_region("Red*")}));
  RegionRecipe region = mesh_region("");
  region.island_at = Vector3(0.3, 0.41, -0.41);  // beside a corner of its hem
  CHECK(layout_tissue(character, recipe_of({region})).stiffness == by_mesh.stiffness);
  const auto [first, last] = span_of(character, "Red_Cape");
  character.materials = {{"Felt", {}}};
  for (size_t v = first; v < last; ++v) character.materials[0].vertices.push_back(static_cast<int>(v));
  region = mesh_region("");
  region.material = "Fe*";
  CHECK(layout_tissue(character, recipe_of({region})).stiffness == by_mesh.stiffness);
  region.mesh = "Red_Cape";
  region.joints = {"chest"};
  CHECK(layout_tissue(character, recipe_of({region})).stiffness == by_mesh.stiffness);
}

TEST_CASE("bones_and_a_mesh_together_select_what_both_have") {
  Bust bust;
  bust.figure.tube({bust.head}, {0.6, 1.5, 0}, 0.02);
  bust.figure.tube({bust.chest}, {0.6, 1.2, 0}, 0.02);
  bust.figure.mesh("Straps", false);
  RegionRecipe region = mesh_region("Straps");
  region.joints = {"head"};
  const TissueLayout layout = layout_tissue(bust.figure.character, recipe_of({region}));
  CHECK(stiffness_between(bust.figure.character, layout, "Straps", 1.4, 1.6) < 0.8);
  CHECK(stiffness_between(bust.figure.character, layout, "Straps", 1.1, 1.3) == 1);
}

TEST_CASE("a_hat_is_held_about_the_skull_and_soft_at_its_point") {
  Bust bust;
  bust.figure.tube({bust.mark({0, 1.7, 0})}, {0, 2.4, 0}, 0.13);
  bust.figure.mesh("Hat", false);
  bust.fasten_marked();
  RegionRecipe region = mesh_region("Hat");
  region.kind = SoftKind::kHat;
  const TissueLayout layout = layout_tissue(bust.figure.character, recipe_of({region}));
  REQUIRE(layout.regions.size() == 1);
  CHECK(layout.regions[0].frequency_hz ==
        Approx(default_frequency_hz(SoftKind::kHat, 2 * layout.regions[0].radius_m)));
  CHECK(stiffness_between(bust.figure.character, layout, "Hat", 1.6, 1.8) > 0.95);
  CHECK(stiffness_between(bust.figure.character, layout, "Hat", 2.3, 2.5) < 0.2);
}

TEST_CASE("cards_of_hair_that_meet_are_one_region_and_far_apart_ones_are_two") {
  Bust bust;
  for (int card = 0; card < 5; ++card)
    bust.figure.sheet({bust.head}, {0.04 * card - 0.08, 0.9, -0.5}, {0.01, 0, 0});
  bust.figure.mesh("Hair", false);
  Character character = bust.figure.character;
  const TissueLayout layout = layout_tissue(character, recipe_of({mesh_region("Hair")}));
  REQUIRE(layout.regions.size() == 1);
  CHECK(layout.regions[0].kind == SoftKind::kHair);
  CHECK(connected(layout));
  std::set<int> cards;
  for (const ControlNode& node : layout.nodes)
    cards.insert(static_cast<int>(std::lround(25 * node.position.x() * 0.9 / (1.5 - node.position.y()))));
  CHECK(cards.size() >= 5);  // nodes stand on every card
  const TissueLayout coarser =
      coarser_layout(character, recipe_of({mesh_region("Hair")}), layout, {layout.nodes[0].vertex}, 12);
  CHECK(coarser.nodes.size() == 12);
  CHECK(connected(coarser));

  Bust twins;
  for (const double side : {-1.0, 1.0})
    twins.figure.sheet({twins.mark({0.13 * side, 1.6, 0})}, {0.7 * side, 1.3, 0}, {0, 0, 0.05});
  twins.figure.mesh("Pigtails", false);
  twins.fasten_marked();
  Character pair = twins.figure.character;
  const TissueLayout two = layout_tissue(pair, recipe_of({mesh_region("Pigtails")}));
  REQUIRE(two.regions.size() == 2);
  CHECK(std::set{two.regions[0].name, two.regions[1].name} == std::set<std::string>{"piece_l", "piece_r"});
}

TEST_CASE("what_a_piece_has_is_left_by_regions_of_bones") {
  Bust bust;
  bust.add_cape();
  RegionRecipe belly;
  belly.name = "belly";
  belly.joints = {"chest"};
  const TissueLayout layout =
      layout_tissue(bust.figure.character, recipe_of({belly, mesh_region("Red_Cape")}));
  REQUIRE(layout.regions.size() == 2);
  const auto [first, last] = span_of(bust.figure.character, "Red_Cape");
  for (const Region& region : layout.regions)
    for (const int v : region.vertices) {
      const bool in_cape = static_cast<size_t>(v) >= first && static_cast<size_t>(v) < last;
      CHECK(in_cape == (region.name == "piece"));
    }
}

TEST_CASE("a_piece_on_bones_of_its_own_takes_them_from_rods") {
  Bust bust;
  const std::vector<int> tail = bust.figure.chain("cape_", bust.chest, {0, 1.3, -0.2}, {0, -0.3, 0}, 3);
  bust.figure.sheet(tail, {0, 0.4, -0.2}, {0.3, 0, 0});
  bust.figure.mesh("Cape", true);
  Character character = bust.figure.character;
  CHECK(layout_tissue(character, {}).rods.size() == 1);
  const TissueLayout layout = layout_tissue(character, recipe_of({mesh_region("Cape")}));
  CHECK(layout.rods.empty());
  REQUIRE(layout.regions.size() == 1);
  CHECK(stiffness_between(character, layout, "Cape", 0.35, 0.45) == Approx(0.1));
  CHECK(stiffness_between(character, layout, "Cape", 1.25, 1.35) > 0.95);
}

TEST_CASE("the_closest_place_of_a_triangle_is_on_its_face_edges_or_corners") {
  Character character;
  character.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  character.triangles = {{0, 1, 2}};
  const ClosestPlace triangle(character, {0});
  const double exact = 1e-12;  // of doubles of size one
  const auto distance_m = [&](const Vector3& p) { return triangle.find(p, 10).value().distance_m; };
  CHECK(std::abs(distance_m({0.2, 0.2, -0.5}) - 0.5) < exact);
  CHECK(std::abs(distance_m({1, 1, 0}) - std::sqrt(0.5)) < exact);
  CHECK(std::abs(distance_m({-3, -4, 0}) - 5) < exact);
  CHECK_FALSE(triangle.find({-3, -4, 0}, 4.9).has_value());
}

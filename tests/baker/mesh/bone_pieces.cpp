// bone_pieces.cpp  What hangs on one bone: certain by its name, doubtful without one.
#include "baker/mesh/parts/bone_pieces.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "figure.hpp"

using namespace sinew::baker;
using Catch::Contains;

namespace {

struct Bust {
  Figure figure{"bust"};
  int pelvis, chest, head;

  Bust() {
    pelvis = figure.joint("pelvis", -1, {0, 0.9, 0});
    chest = figure.joint("chest", pelvis, {0, 1.2, 0});
    head = figure.joint("head", chest, {0, 1.5, 0});
    figure.tube({pelvis, chest}, {0, 1.45, 0}, 0.18);
    figure.tube({head}, {0, 1.8, 0}, 0.12);
    figure.mesh("Body", true);
  }
};

std::vector<BonePiece> pieces_of(const Character& character) {
  return bone_pieces(character, find_surface(character));
}

// Gives what was added since `first` this material.
void paint(Character& character, const std::string& material, size_t first) {
  character.materials.push_back({material, {}});
  for (size_t v = first; v < character.positions.size(); ++v)
    character.materials.back().vertices.push_back(static_cast<int>(v));
}

}  // namespace

TEST_CASE("a_body_alone_and_hard_things_on_it_are_no_pieces") {
  CHECK(pieces_of(Figure("nothing").character).empty());
  Bust bust;
  CHECK(pieces_of(bust.figure.character).empty());
  const size_t first = bust.figure.character.positions.size();
  bust.figure.sheet({bust.chest}, {0, 0.4, -0.5}, {0.1, 0, 0});
  bust.figure.mesh("Great_Sword", false);
  paint(bust.figure.character, "Ribbon", first);  // its grip is wound with one
  const size_t thing = bust.figure.character.positions.size();
  bust.figure.sheet({bust.chest}, {0.2, 0.4, -0.5}, {0.1, 0, 0});
  bust.figure.mesh("Thing", false);
  paint(bust.figure.character, "Metal", thing);
  const int slot = bust.figure.joint("weapon_slot", bust.chest, {0.3, 1.2, 0});
  bust.figure.sheet({slot}, {0.9, 1.2, 0}, {0, 0.05, 0});
  bust.figure.mesh("Ribbon", false);  // whatever is held there
  CHECK(pieces_of(bust.figure.character).empty());
}

TEST_CASE("cards_of_one_mesh_on_one_bone_are_one_certain_piece") {
  Bust bust;
  for (int card = 0; card < 6; ++card)
    bust.figure.sheet({bust.head}, {0.05 * card - 0.1, 0.9, -0.5}, {0.02, 0, 0});
  bust.figure.mesh("Back_Hair", false);
  const std::vector<BonePiece> pieces = pieces_of(bust.figure.character);
  REQUIRE(pieces.size() == 1);
  CHECK(pieces[0].doubt.empty());
  CHECK(pieces[0].evidence == Evidence::kMeshName);
  CHECK(pieces[0].why == "mesh 'Back_Hair' hangs on one bone, 'head'");
  CHECK(pieces[0].region.mesh == "Back_Hair");
  CHECK(pieces[0].region.joints.empty());  // all of the mesh is on that bone
  CHECK(pieces[0].region.kind == SoftKind::kHair);
  CHECK(pieces[0].joint == bust.head);
}

TEST_CASE("a_material_names_a_piece_of_a_mesh_that_does_not") {
  Bust bust;
  const size_t first = bust.figure.character.positions.size();
  bust.figure.sheet({bust.head}, {0, 0.9, -0.5}, {0.05, 0, 0});
  bust.figure.sheet({bust.chest}, {0.7, 0.9, 0}, {0, 0.05, 0});
  bust.figure.mesh("Parts", true);
  paint(bust.figure.character, "M_Hair_01", first);
  Character character = bust.figure.character;
  const std::vector<BonePiece> pieces = pieces_of(character);
  REQUIRE(pieces.size() == 2);
  CHECK(pieces[0].region.material == "M_Hair_01");
  CHECK(pieces[0].region.joints == std::vector<std::string>{"head"});
  CHECK(pieces[1].region.joints == std::vector<std::string>{"chest"});
  CHECK(pieces[1].evidence == Evidence::kMaterialName);
  const TissueLayout layout = layout_tissue(character, {});
  REQUIRE(layout.regions.size() == 2);
  CHECK(layout.regions[0].evidence == Evidence::kMaterialName);
}

TEST_CASE("what_sticks_out_far_without_a_name_is_doubtful_and_stays_rigid") {
  Bust bust;
  bust.figure.sheet({bust.head}, {0, 0.9, -0.5}, {0.05, 0, 0});
  bust.figure.mesh("Object_7", false);
  bust.figure.sheet({bust.chest}, {0.6, 1.2, 0}, {0, 0.05, 0});
  bust.figure.sheet({bust.pelvis}, {-0.6, 0.9, 0}, {0, 0.05, 0});
  bust.figure.mesh("Rest", true);
  Character character = bust.figure.character;
  const std::vector<BonePiece> pieces = pieces_of(character);
  REQUIRE(pieces.size() == 3);
  CHECK(pieces[0].region.mesh == "Object_7");  // the largest first
  CHECK(pieces[1].region.island_at.has_value());
  for (const BonePiece& piece : pieces) {
    CHECK_FALSE(piece.is_named);
    CHECK_THAT(piece.doubt, Contains("no name"));
    CHECK_THAT(piece.why, Contains("hangs on one bone") && Contains("sticks out by"));
  }
  CHECK(layout_tissue(character, {}).regions.empty());
  Recipe recipe;  // an artist who enables them gets what they say
  recipe.states_regions = true;
  for (const BonePiece& piece : pieces) recipe.regions.push_back(piece.region);
  const TissueLayout layout = layout_tissue(character, recipe);
  REQUIRE(layout.regions.size() == 3);
  for (size_t p = 0; p < pieces.size(); ++p)
    for (const int v : layout.regions[p].vertices)
      CHECK(std::ranges::any_of(
          pieces, [&](const BonePiece& piece) { return std::ranges::binary_search(piece.vertices, v); }));
}

TEST_CASE("doubts_about_named_pieces_say_what_they_are") {
  Bust bust;
  bust.figure.tube({bust.head}, {0, 1.79, 0}, 0.125);
  bust.figure.mesh("Wig", false);  // a cap
  const int tip = bust.figure.joint("tip", bust.chest, {0.18, 1.2, 0});
  bust.figure.sheet({tip}, {0.2, 1.2, 0}, {0, 0.005, 0});
  bust.figure.mesh("Tassel", false);
  const int arm = bust.figure.joint("arm", bust.chest, {0.5, 1.2, 0});
  bust.figure.sheet({bust.chest}, {0.4, 0.5, 0}, {0, 0, 0.1});
  bust.figure.sheet({bust.chest, arm}, {0.9, 1.2, 0}, {0, 0, 0.1});
  bust.figure.mesh("Shawl", true);
  std::vector<BonePiece> pieces = pieces_of(bust.figure.character);
  std::erase_if(pieces, [](const BonePiece& piece) { return !piece.is_named; });
  REQUIRE(pieces.size() == 3);
  CHECK_THAT(pieces[0].doubt, Contains("sticks out of the soft tissue of 'head' by"));
  CHECK(pieces[1].doubt == "too small to be seen swinging");
  CHECK(pieces[2].doubt == "some of it moves with several bones");
  Figure cape("cape");
  cape.sheet({cape.joint("root", -1, {0, 1, 0})}, {0, 0, 0}, {0.2, 0, 0});
  cape.mesh("Cape", false);
  pieces = pieces_of(cape.character);
  REQUIRE(pieces.size() == 1);
  CHECK(pieces[0].doubt == "there is no body for it to hang on");
}

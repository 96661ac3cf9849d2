// primitives_pack.cpp  Primitives and tangents go into the file and come out as they were.
#include "baker/pack/character/primitives_pack.hpp"

#include <catch2/catch.hpp>

#include "baker/pack/character/character_pack.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;

namespace {

struct Packed {
  explicit Packed(const Character& of) : character(of), editor(packed(of)) {
    REQUIRE(editor.open(&view).ok());
  }
  static std::vector<std::byte> packed(const Character& of) {
    const TissueLayout layout = test::small_layout(of);
    return pack_character(of, layout, test::small_modes(layout));
  }
  Character character;
  test::PackEditor editor;
  pack::PackView view;
};

}  // namespace

TEST_CASE("a_character_that_was_made_has_one_primitive_and_may_have_no_tangents") {
  Character character = test::small_character();
  character.primitives.clear();
  character.tangents.clear();
  const Packed packed(character);
  REQUIRE(packed.view.primitives.size() == 1);
  const pack::PrimitiveRecord& primitive = packed.view.primitives[0];
  CHECK(primitive.material == pack::kNoIndex);
  CHECK(primitive.vertex_count == 12);
  CHECK(primitive.triangle_count == 16);
  CHECK(primitive.sharer == 0);
  CHECK(packed.view.tangents.empty());
}

TEST_CASE("primitives_keep_mesh_material_ranges_and_whom_they_share_with") {
  const Packed packed(test::small_character());
  REQUIRE(packed.view.primitives.size() == 2);
  const pack::PrimitiveRecord &first = packed.view.primitives[0], &second = packed.view.primitives[1];
  CHECK(std::string(string_at(packed.view, first.material)) == "skin");
  CHECK(first.sharer == 0);
  CHECK(first.triangle_count == 8);
  CHECK(second.material == pack::kNoIndex);
  CHECK(second.mesh == 0);
  CHECK(second.first_vertex == 0);
  CHECK(second.vertex_count == 12);
  CHECK(second.first_triangle == 8);
  CHECK(second.triangle_count == 8);
  CHECK(second.index == 2);
  CHECK(second.sharer == 1);
}

TEST_CASE("tangents_and_the_file_s_unit_come_out_as_they_were") {
  const Packed packed(test::small_character());
  CHECK(packed.view.character->unit_m == 0.01f);
  REQUIRE(packed.view.tangents.size() == 48);
  for (size_t v = 0; v < 12; ++v) {
    CHECK(packed.view.tangents[4 * v + 1] == 1);
    CHECK(packed.view.tangents[4 * v + 3] == (v % 2 == 0 ? 1 : -1));
  }
}

// character_pack.cpp  A whole character goes into the file and comes out as it was.
#include "baker/pack/character/character_pack.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using Catch::Contains;

namespace {

constexpr float kFloatRounding = 1e-6f;  // doubles of order 1 stored as floats

std::vector<std::byte> pack_small(const Character& character, const TissueLayout& layout,
                                  const Safetensors& weights = test::small_weights()) {
  return pack_character(character, layout, test::small_modes(layout), &weights);
}

TissueLayout layout_whose_tip_touches(const Character& character) {
  TissueLayout layout = test::small_layout(character);
  layout.regions[1].touches_body = true;
  return layout;
}

struct Packed {
  Character character = test::small_character();
  TissueLayout layout = layout_whose_tip_touches(character);
  test::PackEditor editor{pack_small(character, layout)};
  pack::PackView view;
  Packed() { REQUIRE(editor.open(&view).ok()); }
};

}  // namespace

TEST_CASE("characters_that_cannot_be_packed_are_refused_with_the_reason") {
  Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  CHECK_THROWS_WITH(pack_small(character, layout, test::small_paper_weights()),
                    Contains("small.safetensors: metadata key 'inputs' is missing (the paper's wiring)"));
  CHECK_THROWS_WITH(
      pack_small(character, layout, test::small_deep_emulator()),
      Contains("'deep_emulator', which `sinew-bake model` bakes; characters take alt_conv_lstm"));
  Safetensors trajectory = test::small_weights();
  trajectory.metadata.erase("sinew.model");
  trajectory.metadata.erase("inputs");
  CHECK_THROWS_WITH(pack_small(character, layout, trajectory),
                    Contains("is this a file of trained weights?"));
  for (const char* key : {"frame", "base"}) {
    Safetensors old = test::small_weights();
    old.metadata.erase(key);
    CHECK_THROWS_WITH(pack_small(character, layout, old), Contains(key) && Contains("train again"));
    old.metadata[key] = "region";
    CHECK_THROWS_WITH(pack_small(character, layout, old), Contains("train again"));
  }

  TissueLayout repeated = layout;
  repeated.edges.emplace_back(1, 0);
  CHECK_THROWS_WITH(pack_small(character, repeated), Contains("bar: control graph"));

  Safetensors weights = test::small_weights();
  weights.metadata["rate_hz"] = "0";
  CHECK_THROWS_WITH(pack_small(character, layout, weights), Contains("'rate_hz' holds 0"));

  character.clips[0].duration_s = 601;
  CHECK_THROWS_WITH(pack_small(character, layout), Contains("clip 'swing' lasts 601"));
  character.joint_node.resize(65536);
  CHECK_THROWS_WITH(pack_small(character, layout), Contains("65536 joints"));
}

TEST_CASE("packing_twice_gives_the_same_bytes") {
  CHECK(test::small_character_pack() == test::small_character_pack());
}

TEST_CASE("joints_keep_names_parents_and_inverse_bind_matrices") {
  const Packed packed;
  REQUIRE(packed.view.joints.size() == 3);
  CHECK(std::string(string_at(packed.view, packed.view.joints[1].name)) == "middle");
  CHECK(packed.view.joints[0].parent == pack::kNoIndex);
  CHECK(packed.view.joints[2].parent == 1);
  CHECK(packed.view.joints[2].inverse_bind[7] == -0.5f);  // row 1, column 3: the tip stands half a metre up
  CHECK(packed.view.character->height_m == 0.5f);
}

TEST_CASE("vertices_keep_place_normal_skin_colour_and_order") {
  const Packed packed;
  for (size_t v = 0; v < packed.character.positions.size(); ++v) {
    for (size_t axis = 0; axis < 3; ++axis) {
      CHECK(packed.view.positions[3 * v + axis] ==
            Approx(packed.character.positions[v][static_cast<long>(axis)]).margin(kFloatRounding));
      CHECK(packed.view.normals[3 * v + axis] ==
            Approx(packed.character.normals[v][static_cast<long>(axis)]).margin(kFloatRounding));
    }
    CHECK(packed.view.skin[v].joint[0] == packed.character.skin[v].joint[0]);
    CHECK(packed.view.skin[v].weight[1] == 0.25f);
    CHECK(packed.view.colors[4 * v + 1] == 150);
  }
  CHECK(packed.view.triangles[3] == 1);
}

// A clip of 0.1 s is six intervals at 60 Hz; the seventh frame is the end pose.
TEST_CASE("clips_are_sampled_at_60_hz_up_to_and_with_their_end") {
  const Packed packed;
  REQUIRE(packed.view.clips.size() == 1);
  REQUIRE(packed.view.clips[0].frame_count == 7);
  for (uint32_t frame = 0; frame < 7; ++frame) {
    const auto joints = joint_matrices(packed.character, &packed.character.clips[0], frame / 60.0);
    for (size_t j = 0; j < 3; ++j)
      for (int k = 0; k < 12; ++k)
        CHECK(packed.view.clip_frames[(frame * 3 + j) * 12 + static_cast<size_t>(k)] ==
              Approx(joints[j](k / 4, k % 4)).margin(kFloatRounding));
  }
}

TEST_CASE("a_clip_that_ends_between_two_samples_keeps_its_end_pose") {
  Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  character.clips[0].duration_s = 0.05 + 1e-3;
  character.clips.push_back({"still", 0, {}});
  test::PackEditor editor(pack_small(character, layout));
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  REQUIRE(view.clips[0].frame_count == 5);
  CHECK(view.clips[1].frame_count == 1);
  const auto end = joint_matrices(character, &character.clips[0], character.clips[0].duration_s);
  CHECK(view.clip_frames[(4 * 3 + 1) * 12 + 1] == Approx(end[1](0, 1)).margin(kFloatRounding));
}

TEST_CASE("regions_keep_nodes_graph_and_carrying_weights") {
  const Packed packed;
  REQUIRE(packed.view.regions.size() == 2);
  const pack::RegionRecord& tip = packed.view.regions[1];
  CHECK(std::string(string_at(packed.view, tip.name)) == "tip");
  CHECK(tip.first_node == 3);
  CHECK(packed.view.regions[0].anchor_node == 1);
  CHECK(tip.anchor_node == 0);
  CHECK(packed.view.region_vertices[tip.first_vertex + 3] == 11);
  CHECK(tip.displacement_limit_m == Approx(0.35 * tip.radius_m));
  CHECK(tip.touches_body == 1);
  CHECK(packed.view.regions[0].touches_body == 0);
  CHECK(tip.padded_vertices == 16);
  CHECK(packed.view.carry[tip.carry + 16 + 3] == 0.5f);  // its second node to its last vertex
  CHECK(packed.view.carry[tip.carry + 16 + 4] == 0.0f);
  CHECK(packed.view.nodes[3].region == 1);
  CHECK(packed.view.nodes[1].stiffness == Approx(packed.character.stiffness[5]));
  CHECK(packed.view.graph_values[0] == 0.5f);        // node 0 has one neighbour
  CHECK(std::isnan(packed.view.tiers[2].error_mm));  // measured on another body
}

TEST_CASE("a_normal_without_length_is_packed_as_up") {
  Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  character.normals[0] = {0, 0, 0};
  character.normals[1] *= 7;
  test::PackEditor editor(pack_small(character, layout));
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  CHECK(view.normals[1] == 1.0f);
}

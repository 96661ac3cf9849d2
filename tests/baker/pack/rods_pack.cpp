// rods_pack.cpp  Rods go into the file and come out as they were.
#include "baker/pack/character/rods_pack.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "sinew/types.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/random_coping_net.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using Catch::Contains;

TEST_CASE("rods_come_out_of_a_pack_as_they_went_in") {
  test::PackEditor editor(test::small_rod_pack());
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  const Rod rod = test::small_rods()[0];
  REQUIRE(view.rods.size() == 1);
  CHECK(std::string(string_at(view, view.rods[0].name)) == rod.name);
  CHECK(view.rods[0].attach == 0);
  CHECK(view.rods[0].end_holder == 0);  // none
  CHECK(view.rods[0].gravity == 2);
  CHECK(view.rods[0].sag == 0.25f);
  REQUIRE(view.rod_segments.size() == 3);
  for (size_t b = 0; b < 3; ++b) {
    const pack::RodSegmentRecord& s = view.rod_segments[b];
    CHECK(s.joint == static_cast<uint32_t>(rod.bones[b].joint));
    CHECK(s.parent == static_cast<uint32_t>(rod.bones[b].parent));
    CHECK(s.begin_m[1] == static_cast<float>(rod.bones[b].begin.y()));
    CHECK(s.end_m[1] == static_cast<float>(rod.bones[b].end.y()));
    CHECK(s.radius_m == 0.1f);
    CHECK(s.density_kg_m3 == 900);
    CHECK(s.young_modulus_pa == 1e5f);
    CHECK(s.torsion_modulus_pa == 2e5f);
    CHECK(s.damping_s == 0.02f);
    CHECK(s.drag_per_s == 0.5f);
  }
  CHECK(std::vector<uint32_t>(view.joint_rods.begin(), view.joint_rods.end()) ==
        std::vector<uint32_t>{pack::kNoIndex, 0, 2});
}

TEST_CASE("who_holds_a_rod_s_end_is_in_the_pack") {
  const Character character = test::small_character();
  TissueLayout layout = test::small_layout(character);
  layout.rods = test::small_rods();
  layout.rods[0].end_joint = 0;
  test::PackEditor editor(pack_character(character, layout, test::small_modes(layout)));
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  CHECK(view.rods[0].end_holder == 1);
}

namespace {

std::vector<std::byte> learned_pack(const Safetensors* weights) {
  const Character character = test::small_character();
  TissueLayout layout = test::small_layout(character);
  layout.rods = test::small_rods();
  layout.rods[0].learned_start = true;
  return pack_character(character, layout, test::small_modes(layout), nullptr, {}, weights);
}

std::string refusal(const Safetensors& weights) {
  try {
    learned_pack(&weights);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("weights_that_no_rod_can_start_from_are_refused_by_name") {
  CHECK(
      refusal(test::small_weights()).find("'sinew.model' is 'alt_conv_lstm'; rods start from a coping_net") !=
      std::string::npos);
  CHECK(refusal(test::small_deep_emulator()).find("rods start from a coping_net") != std::string::npos);
  CHECK(
      refusal(test::small_coping_net()).find("'latent' is 5; rods start from a network of a multiple of 8") !=
      std::string::npos);
  CHECK(refusal(test::random_coping_net(72)).find("'latent' is 72") != std::string::npos);
  CHECK(refusal(test::random_coping_net(8, 2, 1, 1001)).find("'norm.node' holds a norm above 1000") !=
        std::string::npos);
  Safetensors damaged = test::random_coping_net();
  damaged.tensors["encoder.node.0.bias"] = tensor_f32({8}, std::vector<float>(8, NAN));
  CHECK(refusal(damaged).find("'encoder.node.0.bias' holds NaN") != std::string::npos);
}

TEST_CASE("a_learned_start_is_in_the_pack_with_its_network_and_without_weights_it_is_continued") {
  const Safetensors weights = test::random_coping_net(16, 2, 1);
  test::PackEditor editor(learned_pack(&weights)), without(learned_pack(nullptr));
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  CHECK(view.rods[0].start == 1);
  REQUIRE(view.rod_network.record);
  CHECK(view.rod_network.record->model == pack::ModelKind::kCopingNet);
  CHECK(view.rod_network.record->max_channels == 16);
  CHECK(view.rod_network.layers.size() == 16);  // of two layers, eight chains
  const float cost_us = view.tiers.back().cost_us;
  REQUIRE(without.open(&view).ok());
  CHECK(view.rods[0].start == 0);
  CHECK_FALSE(view.rod_network.record);
  CHECK(view.tiers.back().cost_us < cost_us);
}

TEST_CASE("rods_cost_every_simulated_tier_and_no_other") {
  pack::PackView with, without;
  test::PackEditor one(test::small_rod_pack()), other(test::small_weightless_pack());
  REQUIRE(one.open(&with).ok());
  REQUIRE(other.open(&without).ok());
  for (size_t t = 0; t < with.tiers.size(); ++t) {
    const bool simulated = with.tiers[t].tier >= static_cast<uint32_t>(Tier::kNetwork);
    CHECK((with.tiers[t].cost_us > without.tiers[t].cost_us) == simulated);
  }
}

TEST_CASE("a_rod_that_hangs_on_another_is_refused_by_the_reader") {
  const Character character = test::small_character();
  TissueLayout layout = test::small_layout(character);
  Rod lower = test::small_rods()[0], upper = lower;
  lower.bones.resize(1);
  upper.attach = 1;
  upper.bones = {test::small_rods()[0].bones[2]};
  upper.bones[0].parent = -1;
  layout.rods = {lower, upper};
  test::PackEditor editor(pack_character(character, layout, test::small_modes(layout)));
  CHECK_THAT(editor.open().message, Contains("rod 1: hangs on a bone that a rod moves"));
}

TEST_CASE("a_character_of_rods_alone_is_taken_and_a_rigid_one_too") {
  const Character character = test::small_character();
  TissueLayout layout;
  layout.rods = test::small_rods();
  test::PackEditor editor(pack_character(character, layout, {}));
  CHECK(editor.open().ok());
  layout.rods.clear();
  test::PackEditor rigid(pack_character(character, layout, {}));
  CHECK(rigid.open().ok());
}

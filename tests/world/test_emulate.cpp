// test_emulate.cpp  Regions whose patches a network predicts: whatever it says, they stay and rest; they are
// simulated, saved and shown as others are.
#include <cmath>
#include <cstring>
#include <random>

#include "baker/pack/pack_writer.hpp"
#include "pack/reader.hpp"
#include "tests/pack/small_pack.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

// All weights Gaussian, of this deviation; 0: it has nothing to add to going on.
baker::Safetensors emulator(float deviation, uint32_t seed = 1) {
  baker::Safetensors weights = test::small_emulator();
  std::mt19937 random(seed);
  std::normal_distribution<float> gauss;
  for (auto& [name, tensor] : weights.tensors)
    for (size_t at = 0; at + sizeof(float) <= tensor.bytes.size(); at += sizeof(float)) {
      const float value = deviation * gauss(random);
      std::memcpy(tensor.bytes.data() + at, &value, sizeof value);
    }
  return weights;
}

scenes::PackBytes emulated_block(const baker::Safetensors& weights, bool network_too = false) {
  scenes::BlockOptions options;
  options.network = network_too;
  options.emulator = &weights;
  return scenes::soft_block(options);
}

// With the bytes that its asset is.
struct Emulated {
  explicit Emulated(const baker::Safetensors& weights, WorldDef def = {}, bool network_too = false)
      : pack(emulated_block(weights, network_too)), stage(1, def, pack) {}
  scenes::PackBytes pack;
  Stage stage;
};

scenes::BlockPose still(double) { return {}; }

}  // namespace

TEST_CASE("an_emulated_region_is_simulated_as_the_network_tier") {
  Emulated block(emulator(0.2f));
  Stage& stage = block.stage;
  stage.play(scenes::walk, 1);
  CHECK(stage.report().tier == Tier::kNetwork);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) > 1e-3);
}

namespace {

// As a bake states errors that measured them.
scenes::PackBytes measured_block(const baker::Safetensors& weights, float of_network, float of_modes) {
  const scenes::PackBytes unmeasured = emulated_block(weights);
  pack::PackView view;
  REQUIRE(pack::open_pack(unmeasured.bytes(), &view).ok());
  std::vector<pack::TierRecord> tiers(view.tiers.begin(), view.tiers.end());
  for (pack::TierRecord& tier : tiers)
    tier.error_ratio = tier.tier == static_cast<uint32_t>(Tier::kNetwork) ? of_network
                       : tier.tier == static_cast<uint32_t>(Tier::kModal) ? of_modes
                                                                          : 1.0f;
  baker::PackWriter writer = baker::PackWriter::from_pack(unmeasured.bytes());
  writer.section(pack::SectionKind::kTiers, tiers);
  const std::vector<std::byte> bytes = writer.finish();
  return {bytes.data(), bytes.size()};
}

}  // namespace

// The recipe has chosen.
TEST_CASE("emulated_flesh_moves_by_its_network_wherever_modes_are_nearer") {
  const baker::Safetensors weights = emulator(0.2f);
  for (const float of_network : {0.7f, 0.97f, 1.2f}) {
    const scenes::PackBytes measured = measured_block(weights, of_network, 0.5f);
    Stage stage(1, {}, measured);
    stage.play(scenes::walk, 1);
    CHECK(stage.report().tier == Tier::kNetwork);
  }
}

TEST_CASE("what_a_network_says_of_patches_is_seen") {
  Emulated one(emulator(0.2f, 1)), other(emulator(0.2f, 2));
  one.stage.play(scenes::walk, 1);
  other.stage.play(scenes::walk, 1);
  CHECK(one.stage.read() != other.stage.read());
}

// Ten thousand ticks of a walk, of weights from none to wild.
TEST_CASE("no_weights_make_emulated_flesh_explode") {
  for (const float deviation : {0.0f, 0.1f, 1.0f, 30.0f}) {
    Emulated block(emulator(deviation), {.sleep_tolerance = 0});
    Stage& stage = block.stage;
    double most = 0;
    for (int tick = 0; tick < 10000; ++tick) {
      stage.step(scenes::walk, kFrame_s);
      if (tick % 50 == 0) most = std::max(most, test::largest_length(stage.read(0, Space::kBind)));
    }
    INFO("deviation " << deviation << ": " << most << " m");
    // Held within 0.75 of a radius of 0.2 m, and the weights of carrying add up to no more than 1.
    CHECK(most < 0.2);
    CHECK(stage.report().restarts == 0);
  }
}

TEST_CASE("emulated_flesh_comes_to_rest_whatever_its_network_says") {
  for (const float deviation : {0.0f, 0.2f, 30.0f}) {
    Emulated block(emulator(deviation), {.sleep_tolerance = 0});
    Stage& stage = block.stage;
    stage.play(scenes::walk, 2);
    scenes::BlockPose last = scenes::walk(stage.time_s);
    stage.play([&](double) { return last; }, 20);
    const std::vector<float> before = stage.read();
    stage.play([&](double) { return last; }, 1);
    double moved = 0;
    const std::vector<float> after = stage.read();
    for (size_t i = 0; i < after.size(); ++i)
      moved = std::max(moved, std::abs(static_cast<double>(after[i]) - static_cast<double>(before[i])));
    INFO("deviation " << deviation);
    CHECK(moved < 1e-5);  // metres a second
  }
}

TEST_CASE("an_emulated_block_in_its_bind_pose_is_not_displaced") {
  Emulated block(emulator(0.2f));
  Stage& stage = block.stage;
  stage.play(still, 1);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-6);
}

TEST_CASE("what_follows_a_restore_of_emulated_flesh_has_the_bits_of_what_followed_the_save") {
  Emulated block(emulator(0.2f), {}, true);
  Stage& stage = block.stage;
  stage.play(scenes::walk, 0.5);
  const std::vector<std::byte> saved = stage.save();
  const double from_s = stage.time_s;
  stage.play(scenes::walk, 0.3, 45);
  const std::vector<float> want = stage.read();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  stage.time_s = from_s;
  stage.play(scenes::walk, 0.3, 45);
  CHECK(stage.read() == want);
}

TEST_CASE("far_from_the_origin_emulated_flesh_moves_alike") {
  const scenes::PackBytes pack = emulated_block(emulator(0.2f));
  Stage here(1, {}, pack), far(1, {}, pack);
  for (int frame = 0; frame < 60; ++frame) {
    here.step(scenes::walk, kFrame_s);
    far.step(
        [](double t) {
          scenes::BlockPose pose = scenes::walk(t);
          pose.root.position_m[0] += 65536;
          return pose;
        },
        kFrame_s);
  }
  const std::vector<float> a = here.read(0, Space::kBind), b = far.read(0, Space::kBind);
  float off = 0;
  for (size_t i = 0; i < a.size(); ++i) off = std::max(off, std::abs(a[i] - b[i]));
  // Roots are doubles, of 1.5e-11 m there; a wild network passes on a hundred times what it is told.
  CHECK(off < 1e-5f);
}

// The budget takes the network away and gives it back.
TEST_CASE("tiers_of_emulated_flesh_change_without_a_jump") {
  const scenes::PackBytes pack = emulated_block(emulator(0.1f));
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits}, pack);
  REQUIRE(stage.world.set_budget_us(1e6f).ok());
  std::vector<float> before;
  double usual = 0, most = 0;
  for (int frame = 0; frame < 240; ++frame) {
    if (frame % 60 == 30) REQUIRE(stage.world.set_budget_us(frame % 120 == 30 ? 20.0f : 1e6f).ok());
    stage.step(scenes::walk, kFrame_s);
    const std::vector<float> now = stage.read(0, Space::kBind);
    double step = 0;
    for (size_t i = 0; i < before.size(); ++i)
      step = std::max(step, std::abs(static_cast<double>(now[i]) - static_cast<double>(before[i])));
    (frame % 60 == 30 ? most : usual) = std::max(frame % 60 == 30 ? most : usual, step);
    before = now;
  }
  CHECK(most < 1.5 * usual);
}

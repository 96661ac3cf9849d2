// test_guards.cpp  Each guard is seen to fire, and the world goes on.
#include <cstring>
#include <limits>

#include "tests/world/stage.hpp"
#include "world/instance.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

scenes::BlockPose strong_shake(double t) { return scenes::shake(t, 12); }

// Bytes of a snapshot's header and its checksum's place; world/snapshot.cpp.
constexpr size_t kHeaderBytes = 40, kChecksumAt = 24;

// A NaN at `share` of the network's state, smuggled in through a snapshot whose checksum is right.
void poison(Stage& stage, double share) {
  world::Asset asset;
  world::Instance twin;
  REQUIRE(world::open_asset(test::block_pack().bytes(), &asset).ok());
  REQUIRE(world::make_instance(asset, {}, {}, 1, &twin).ok());
  const size_t floats = tissue::state_floats(asset.network, asset.node_count());
  const auto start = static_cast<size_t>(reinterpret_cast<std::byte*>(twin.network_state) -
                                         reinterpret_cast<std::byte*>(twin.state));
  std::vector<std::byte> bytes = stage.save();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // The first channel of a node's row: the others may be padding, which nothing reads.
  const size_t at = static_cast<size_t>(share * static_cast<double>(floats)) / 16 * 16;
  std::memcpy(bytes.data() + kHeaderBytes + start + sizeof(float) * at, &nan, sizeof nan);
  const uint64_t checksum = core::hash64(std::span(bytes).subspan(kHeaderBytes));
  std::memcpy(bytes.data() + kChecksumAt, &checksum, sizeof checksum);
  REQUIRE(stage.world.restore_state(stage.blocks[0], bytes).ok());
}

}  // namespace

TEST_CASE("inputs_beyond_the_envelope_are_clamped_and_counted") {
  Stage stage;
  stage.play(strong_shake, 2);
  CHECK(stage.report().input_clamps > 0);
  CHECK(test::all_finite(stage.read()));
}

TEST_CASE("displacement_beyond_the_limit_is_held_and_counted") {
  constexpr double kShare = 0.2;
  const scenes::PackBytes tight = scenes::soft_block({.displacement_limit = kShare});
  Stage stage(1, {}, tight);
  double largest_m = 0;
  for (int f = 0; f < 90; ++f) {
    stage.step(strong_shake, kFrame_s);
    largest_m = std::max(largest_m, test::largest_length(stage.read(0, Space::kBind)));
  }
  CHECK(stage.report().displacement_clamps > 0);
  // Radius 0.2 m or so; skinning bends the bind-space delta a little.
  CHECK(largest_m < 1.3 * kShare * 0.25);
  CHECK(largest_m > 0.02);
}

TEST_CASE("instance_that_stays_at_its_limit_is_restarted") {
  const scenes::PackBytes tiny = scenes::soft_block({.displacement_limit = 0.003});
  Stage stage(1, {}, tiny);
  uint32_t restarts = 0;
  for (int f = 0; f < 300; ++f)
    restarts += stage.step([](double t) { return scenes::shake(t, 2); }, kFrame_s).restarts;
  CHECK(restarts >= 1);
  CHECK(stage.report().restarts == restarts);
}

// NaN anywhere in the state: faded to skinning, restarted, counted; the neighbour does not notice.
TEST_CASE("nan_in_the_state_fades_to_skinning_and_restarts") {
  for (const double share : {0.0, 0.1, 0.3, 0.5, 0.7, 0.95}) {
    INFO("NaN at " << share << " of the network's state");
    Stage stage(2);
    stage.play(scenes::walk, 1);
    poison(stage, share);
    uint32_t restarts = 0;
    bool finite = true;
    float least_blend = 1;
    for (int f = 0; f < 90; ++f) {
      restarts += stage.step(scenes::walk, kFrame_s).restarts;
      finite = finite && test::all_finite(stage.read());
      least_blend = std::min(least_blend, stage.report().blend);
    }
    CHECK(restarts == 1);
    CHECK(stage.report(0).restarts == 1);
    CHECK(stage.report(1).restarts == 0);
    CHECK(finite);
    CHECK(least_blend == 0);                        // it went down to skinning
    CHECK(stage.report(0).tier == Tier::kNetwork);  // and came back
    CHECK(stage.report(0).blend == 1);
  }
}

TEST_CASE("restart_does_not_pop") {
  constexpr double kPop = 2;  // as in test_blend
  Stage stage, sound;
  stage.play(scenes::walk, 1.5);
  sound.play(scenes::walk, 1.5);
  double worst_m = 0, usual_m = 0;
  std::vector<float> before = stage.read(0, Space::kBind), sound_before = before;
  for (int f = 0; f < 600; ++f) {
    if (f % 101 == 0) poison(stage, 0.3);
    stage.step(scenes::walk, kFrame_s);
    sound.step(scenes::walk, kFrame_s);
    const std::vector<float> now = stage.read(0, Space::kBind), sound_now = sound.read(0, Space::kBind);
    worst_m = std::max(worst_m, test::largest_distance(now, before));
    usual_m = std::max(usual_m, test::largest_distance(sound_now, sound_before));
    before = now;
    sound_before = sound_now;
  }
  REQUIRE(stage.report().restarts == 6);
  WARN("largest change in a frame with six restarts " << worst_m * 1e3 << " mm, of the sound twin "
                                                      << usual_m * 1e3 << " mm");
  CHECK(worst_m < kPop * usual_m);
}

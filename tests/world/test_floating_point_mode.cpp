// test_floating_point_mode.cpp  Hosts that enable traps or round otherwise get the same bits and no signal.
#include <cfenv>

#include "tests/pack/small_pack.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

// What an engine hands in, made in its usual mode.
std::vector<scenes::BlockPose> walking() {
  std::vector<scenes::BlockPose> poses;
  for (int frame = 0; frame < 90; ++frame) poses.push_back(scenes::walk(frame / 60.0));
  return poses;
}

// All that a frame loop calls, with a budget that makes tiers change.
std::vector<float> played(const std::vector<scenes::BlockPose>& poses) {
  Stage stage(3, {.budget_mode = BudgetMode::kWorkUnits});
  const float modal_us = test::tier_cost_us(Tier::kModal);
  std::vector<float> read;
  const auto keep = [&](const std::vector<float>& values) {
    read.insert(read.end(), values.begin(), values.end());
  };
  for (size_t frame = 0; frame < poses.size(); ++frame) {
    REQUIRE(stage.world.set_budget_us(frame < 30 ? 1e9f : frame < 60 ? modal_us : 0).ok());
    for (const InstanceId block : stage.blocks) stage.pose(block, poses[frame]);
    stage.world.step(1.0f / 60);
    if (frame % 10 > 0) continue;
    keep(stage.read());
    keep(stage.read(0, Space::kWorld));
    std::vector<float> normals(size_t{3} * stage.info.vertex_count);
    REQUIRE(stage.world
                .read_normals(stage.blocks[0], {.out = normals.data(), .capacity = stage.info.vertex_count})
                .ok());
    keep(normals);
  }
  std::vector<std::byte> state(stage.world.state_bytes(stage.blocks[0]));
  REQUIRE(stage.world.save_state(stage.blocks[0], state).ok());
  REQUIRE(stage.world.restore_state(stage.blocks[0], state).ok());
  keep(stage.read());
  return read;
}

}  // namespace

#if defined(__GLIBC__) && defined(__SSE2__)
TEST_CASE("nothing_traps_where_the_host_lets_floating_point_trap") {
  const std::vector<std::byte> unmeasured = test::small_character_pack();  // errors are NaN: not measured
  const scenes::PackBytes& block = test::block_pack();
  const std::vector<scenes::BlockPose> poses = walking();
  (void)played(poses);  // what the test itself prepares may divide as it likes
  std::feclearexcept(FE_ALL_EXCEPT);
  REQUIRE(feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) >= 0);
  core::AlignedBlock aligned(unmeasured.size());
  std::memcpy(aligned.data(), unmeasured.data(), unmeasured.size());
  World world;
  AssetId asset;
  InstanceId instance;
  bool ok = World::create({}, &world).ok() &&
            world.load_asset({aligned.data(), unmeasured.size()}, &asset).ok() &&
            world.create_instance({.asset = asset}, &instance).ok();
  world.step(1.0f / 60);
  world.step(std::numeric_limits<float>::quiet_NaN());
  ok = ok && world.load_asset(block.bytes(), &asset).ok() && !world.set_budget_us(NAN).ok();
  const std::vector<float> read = played(poses);
  const int trapping = fegetexcept();
  fedisableexcept(FE_ALL_EXCEPT);
  CHECK(ok);
  CHECK(trapping == (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW));  // the host's mode came back
  CHECK(test::all_finite(read));
}
#endif

TEST_CASE("the_host_s_rounding_mode_changes_no_bit") {
  const std::vector<scenes::BlockPose> poses = walking();
  const std::vector<float> nearest = played(poses);
  for (const int rounding : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
    REQUIRE(std::fesetround(rounding) == 0);
    const std::vector<float> other = played(poses);
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    CHECK(after == rounding);
    CHECK(other == nearest);
  }
}

// stage.hpp  A world with soft blocks in it, and shorthands that a test can say one property with.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/hash.hpp"
#include "pack/reader.hpp"
#include "sinew/sinew.hpp"
#include "tests/scenes/motions.hpp"
#include "tests/scenes/soft_block.hpp"

namespace sinew::test {

using Motion = std::function<scenes::BlockPose(double time_s)>;

// Made once a process: baking it is the slow part.
inline const scenes::PackBytes& block_pack() {
  static const scenes::PackBytes pack = scenes::soft_block();
  return pack;
}

// The same without a network.
inline const scenes::PackBytes& weightless_pack() {
  static const scenes::PackBytes pack = scenes::soft_block({.network = false});
  return pack;
}

// With a tail and horns that are rods, without a network.
inline const scenes::PackBytes& tailed_pack() {
  static const scenes::PackBytes pack = scenes::soft_block({.network = false, .rods = scenes::RodMatter{}});
  return pack;
}

// With control graphs of 40, 20 and 10 nodes a region.
inline const scenes::PackBytes& levels_pack() {
  static const scenes::PackBytes pack = scenes::soft_block({.nodes = 40, .coarser_nodes = {20, 10}});
  return pack;
}

// Baked, of a tick of one block: a budget in work units that pays for this tier and for none above.
inline float tier_cost_us(Tier tier) {
  pack::PackView view;
  REQUIRE(pack::open_pack(block_pack().bytes(), &view).ok());
  for (const pack::TierRecord& record : view.tiers) {
    if (record.tier == static_cast<uint32_t>(tier)) return record.cost_us;
  }
  FAIL("no such tier");
  return 0;
}

// Programmer errors are counted instead of aborting a debug build.
struct FaultCounter {
  int faults = 0;
  AssertHook hook() {
    const auto fail = [](const char*, const char*, int, void* context) {
      ++static_cast<FaultCounter*>(context)->faults;
    };
    return {.fail = fail, .context = this};
  }
};

struct Stage {
  FaultCounter faults;
  World world;
  AssetId asset;
  AssetInfo info;
  std::vector<InstanceId> blocks;
  double time_s = 0;

  explicit Stage(uint32_t count = 1, WorldDef def = {}, const scenes::PackBytes& pack = block_pack()) {
    def.assert_hook = faults.hook();
    REQUIRE(World::create(def, &world).ok());
    const Status loaded = world.load_asset(pack.bytes(), &asset);
    INFO(loaded.message);
    REQUIRE(loaded.ok());
    REQUIRE(world.asset_info(asset, &info).ok());
    for (uint32_t i = 0; i < count; ++i) add();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  InstanceId add(float importance = 1) {
    InstanceId made;
    REQUIRE(world.create_instance({.asset = asset, .importance = importance}, &made).ok());
    blocks.push_back(made);
    return made;
  }

  void pose(InstanceId block, const scenes::BlockPose& pose) {
    REQUIRE(world.set_pose(block, pose.pose()).ok());
  }

  // All blocks play `motion`, each a little later than the one before.
  FrameReport step(const Motion& motion, double dt_s) {
    constexpr double kStagger_s = 0.07;
    time_s += dt_s;
    for (size_t i = 0; i < blocks.size(); ++i)
      pose(blocks[i], motion(time_s + kStagger_s * static_cast<double>(i)));
    return world.step(static_cast<float>(dt_s));
  }
  void play(const Motion& motion, double seconds, double fps = 60) {
    const auto frames = static_cast<int>(std::lround(seconds * fps));
    for (int f = 0; f < frames; ++f) step(motion, 1 / fps);
  }

  std::vector<float> read(size_t index = 0, Space space = Space::kCharacter) const {
    std::vector<float> out(size_t{3} * info.vertex_count);
    REQUIRE(
        world
            .read_positions(blocks[index], {.space = space, .out = out.data(), .capacity = info.vertex_count})
            .ok());
    return out;
  }
  InstanceReport report(size_t index = 0) const {
    InstanceReport out;
    REQUIRE(world.report(blocks[index], &out).ok());
    return out;
  }
  std::vector<std::byte> save(size_t index = 0) const {
    std::vector<std::byte> out(world.state_bytes(blocks[index]));
    REQUIRE(world.save_state(blocks[index], out).ok());
    return out;
  }
};

// Of its first block, as they are read: 12 numbers each.
inline std::vector<float> joints_of(const Stage& stage) {
  std::vector<Matrix34> joints(stage.info.joint_count);
  REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
  std::vector<float> out;
  for (const Matrix34& joint : joints)
    for (const auto& row : joint.m) out.insert(out.end(), row, row + 4);
  return out;
}

inline uint64_t hash_of(const std::vector<float>& values) {
  return core::hash64(std::as_bytes(std::span(values)));
}
// Of all its blocks.
inline uint64_t hash_of(const Stage& stage) {
  std::vector<float> all;
  for (size_t i = 0; i < stage.blocks.size(); ++i) {
    const std::vector<float> places = stage.read(i);
    all.insert(all.end(), places.begin(), places.end());
  }
  return hash_of(all);
}

// Largest distance between equal vertices, metres.
inline double largest_distance(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (size_t v = 0; v + 2 < a.size(); v += 3) {
    largest = std::max<double>(largest, std::hypot(a[v] - b[v], a[v + 1] - b[v + 1], a[v + 2] - b[v + 2]));
  }
  return largest;
}

inline double largest_length(const std::vector<float>& vectors) {
  return largest_distance(vectors, std::vector<float>(vectors.size()));
}

inline bool all_finite(const std::vector<float>& values) {
  return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

}  // namespace sinew::test

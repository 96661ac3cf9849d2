// snapshot_scenes.hpp  The instances that snapshots are of: those that are written as seeds and those that
// take them.
#pragma once
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "sinew/sinew.hpp"
#include "tests/fuzz/in_motion.hpp"
#include "tests/scenes/soft_block.hpp"

namespace sinew::fuzz {

// Two graphs and a network; rods; arms that press the flesh.
inline std::vector<scenes::PackBytes> snapshot_packs() {
  std::vector<scenes::PackBytes> packs;
  packs.push_back(scenes::soft_block({.cells = 3, .nodes = 6, .coarser_nodes = {4}}));
  packs.push_back(
      scenes::soft_block({.cells = 2, .nodes = 4, .network = false, .rods = scenes::RodMatter{}}));
  packs.push_back(
      scenes::soft_block({.cells = 2, .nodes = 4, .network = false, .arms = scenes::ArmMatter{}}));
  return packs;
}

inline std::vector<std::byte> save(const World& world, InstanceId instance) {
  std::vector<std::byte> bytes(world.state_bytes(instance));
  if (!world.save_state(instance, bytes).ok()) std::abort();
  return bytes;
}

// Alone in its world: a step steps all that are in one.
struct Actor {
  World world = make_world(1, 1);
  AssetId asset;
  InstanceId instance;
  std::vector<std::byte> clean;  // a snapshot of it in motion
};

inline Actor make_actor(const scenes::PackBytes& pack) {
  constexpr int kSteps = 8;
  Actor actor;
  if (!actor.world.load_asset(pack.bytes(), &actor.asset).ok()) std::abort();
  if (!add_instance(actor.world, actor.asset, &actor.instance)) std::abort();
  if (!move_and_read(actor.world, actor.asset, actor.instance, kSteps)) std::abort();
  actor.clean = save(actor.world, actor.instance);
  return actor;
}

}  // namespace sinew::fuzz

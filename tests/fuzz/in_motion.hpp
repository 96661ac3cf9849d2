// in_motion.hpp  An instance of whatever asset, moved and read in every way.
#pragma once
#include <vector>

#include "sinew/sinew.hpp"

namespace sinew::fuzz {

// One of each at a time.
World make_world(uint32_t assets, uint32_t instances);

// In its bind pose, with contacts between its parts and its bones' capsules, and rods started as they can be
// at best. False where the world refuses.
bool add_instance(World& world, AssetId asset, InstanceId* out);

// So many steps under a root that moves and turns, a clip where there is one; then all is read. Returns
// whether all that was read is finite.
bool move_and_read(World& world, AssetId asset, InstanceId instance, int steps);

}  // namespace sinew::fuzz

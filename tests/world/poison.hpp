// poison.hpp  Puts a NaN into the state of an instance, as a fault of the hardware or of the code would.
#pragma once
#include <cstring>
#include <limits>

#include "character/asset/open_asset.hpp"
#include "character/instance.hpp"
#include "character/life/create_instance.hpp"
#include "tests/world/stage.hpp"
#include "tissue/network/network.hpp"

namespace sinew::test {

// Bytes of a snapshot's header and its checksum's place; character/life/snapshot.cpp.
inline constexpr size_t kSnapshotHeaderBytes = 40, kSnapshotChecksumAt = 24;

// A NaN in the state, at the place that `where` points to in a twin, smuggled in through a snapshot whose
// checksum is right.
template <class Where>
void poison(Stage& stage, const Where& where, const scenes::PackBytes& pack = block_pack()) {
  world::Asset asset;
  world::Instance twin;
  REQUIRE(world::open_asset(pack.bytes(), &asset).ok());
  REQUIRE(world::make_instance(asset, {}, &twin).ok());
  const auto at = static_cast<size_t>(reinterpret_cast<std::byte*>(where(twin)) -
                                      reinterpret_cast<std::byte*>(twin.state));
  std::vector<std::byte> bytes = stage.save();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + kSnapshotHeaderBytes + at, &nan, sizeof nan);
  const uint64_t checksum = core::hash64(std::span(bytes).subspan(kSnapshotHeaderBytes));
  std::memcpy(bytes.data() + kSnapshotChecksumAt, &checksum, sizeof checksum);
  REQUIRE(stage.world.restore_state(stage.blocks[0], bytes).ok());
}

// The first channel of a node's row, of halves the second: the others may be padding, which nothing reads.
inline auto in_network(double share) {
  return [share](const world::Instance& twin) {
    const size_t floats = tissue::state_floats(twin.asset->network, twin.asset->node_count());
    return twin.tissue.network_memory + static_cast<size_t>(share * static_cast<double>(floats)) / 16 * 16;
  };
}

}  // namespace sinew::test

// id.hpp  Value ids with a generation; an id that is all zero is null. Stand-alone.
#pragma once
#include <cstdint>

namespace sinew {

struct AssetId {
  uint32_t index1 = 0;      // slot + 1
  uint32_t generation = 0;  // counts re-uses of the slot; a destroyed object's id never becomes valid again
  friend bool operator==(AssetId, AssetId) = default;
};

struct InstanceId {
  uint32_t index1 = 0;
  uint32_t generation = 0;
  friend bool operator==(InstanceId, InstanceId) = default;
};

constexpr bool is_null(AssetId id) noexcept { return id.index1 == 0; }
constexpr bool is_null(InstanceId id) noexcept { return id.index1 == 0; }

}  // namespace sinew

// snapshot.hpp  An instance's state as bytes, for rollback.
#pragma once
#include <cstddef>
#include <span>

#include "character/instance.hpp"
#include "sinew/status.hpp"

namespace sinew::world {

// A snapshot is a header (magic, version, the asset's fingerprint, size, checksum) and the state's bytes. It
// is good on the machine architecture it was made on, for the same asset and what of it
// may touch; what follows a restore has the same
// bits as what followed the save.
size_t snapshot_bytes(const Instance& instance) noexcept;
Status save(const Instance& instance, std::span<std::byte> out) noexcept;
// kCorrupt, the instance untouched: not a snapshot, another version, asset or ContactDef, or
// changed bytes.
Status restore(Instance& instance, std::span<const std::byte> bytes) noexcept;

}  // namespace sinew::world

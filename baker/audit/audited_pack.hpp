// audited_pack.hpp  A checked pack in memory, whoever holds it.
#pragma once
#include <cstddef>
#include <span>

#include "pack/reader.hpp"

namespace sinew::baker {

// Both outlive what is made of them.
struct AuditedPack {
  const pack::PackView& view;
  std::span<const std::byte> bytes;  // 64-byte aligned, as World::load_asset wants them
};

}  // namespace sinew::baker

// open_asset.hpp  From a pack's bytes to an asset: checks, views, tables that its instances share.
#pragma once
#include <cstddef>
#include <span>

#include "character/asset/asset.hpp"

namespace sinew::world {

// On refusal *out is untouched.
Status open_asset(std::span<const std::byte> bytes, Asset* out) noexcept;

}  // namespace sinew::world

// reader.hpp  Bytes to checked views. After open_pack returns ok, every index in the views is in range.
#pragma once
#include <cstddef>
#include <span>

#include "pack/pack_view.hpp"
#include "sinew/status.hpp"

namespace sinew::pack {

// Checks everything that is later trusted: magic, version, sizes, checksums, counts against each other, every
// index, offset and string, finite numbers. O(bytes), allocates nothing. bytes must be 64-byte aligned and
// outlive the view. On refusal *out is untouched.
Status open_pack(std::span<const std::byte> bytes, PackView* out) noexcept;

}  // namespace sinew::pack

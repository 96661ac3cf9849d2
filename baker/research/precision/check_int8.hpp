// check_int8.hpp  The int8 sections of a model's pack, which the runtime's reader does not look into.
#pragma once
#include "pack/reader.hpp"
#include "sinew/status.hpp"

namespace sinew::baker {

// Of a pack that open_pack has taken: sections of the size that the layers say, and what the kernels trust.
Status check_int8(const pack::PackView& pack) noexcept;

}  // namespace sinew::baker

// isa.hpp  Which instruction set the runtime computes with. Needs status.hpp.
//
// Chosen once, at first use: the one that the environment variable SINEW_ISA names, or the best the processor
// has when it names none. One that is not available is refused by World::create, and by `sinew-bake check`
// and `judge`; what runs without them uses the best. Targets with fused multiply-adds (avx3, avx2, neon)
// give the same bits.
#pragma once
#include <span>

#include "sinew/export.h"
#include "sinew/status.hpp"

namespace sinew {

// Names of the targets this build has and this processor runs, best first ("avx3", "avx2", "sse4",
// "ssse3", "neon", "emu128", "scalar"). Never empty; they live as long as the process.
SINEW_API std::span<const char* const> available_isas() noexcept;
SINEW_API const char* active_isa() noexcept;

// For all worlds of the process, whatever SINEW_ISA says. Call it while none of them steps. An unknown or
// missing name, or null: kUnsupported, listing the available; nothing changes. Costs nothing afterwards.
SINEW_API Status force_isa(const char* name) noexcept;

}  // namespace sinew

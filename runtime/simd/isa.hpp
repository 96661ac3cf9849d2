// isa.hpp  Which instruction set the kernels use.
//
// Chosen once, at first use: the one that the environment variable SINEW_ISA names, or the best the processor
// has when it names none. One that is not available is refused by World::create and sinew-bake, which ask
// check_environment; kernels called without them use the best. active_isa tells; force_isa changes it.
#pragma once
#include <span>

#include "sinew/status.hpp"

namespace sinew::simd {

// Names of the targets this build has and this processor runs, best first ("avx3_vnni", "avx3", "avx2",
// "sse4", "ssse3", "neon", "emu128", "scalar").
std::span<const char* const> available_isas() noexcept;
const char* active_isa() noexcept;
// SINEW_ISA names an unknown or missing one: kUnsupported, listing the available.
Status check_environment() noexcept;
// Not thread-safe against running steps. An unknown or missing one: kUnsupported, listing the available;
// nothing changes.
Status force_isa(const char* name) noexcept;

}  // namespace sinew::simd

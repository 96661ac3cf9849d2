// isa.hpp  Which instruction set the kernels use: what sinew/isa.hpp offers, and the look at the environment.
#pragma once
#include "sinew/isa.hpp"

namespace sinew::simd {

using sinew::active_isa;
using sinew::available_isas;
using sinew::force_isa;

// SINEW_ISA names an unknown or missing one: kUnsupported, listing the available.
Status check_environment() noexcept;

}  // namespace sinew::simd

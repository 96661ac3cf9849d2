// kernel_tables.hpp  Every table this build has: kernels.cpp makes them, isa.cpp chooses.
#pragma once
#include <span>

#include "simd/kernels.hpp"

namespace sinew::simd {

// Best first; null where a target was not compiled. A table may stand twice at the end (Highway's fallback).
std::span<const Kernels* const> compiled_kernels() noexcept;

}  // namespace sinew::simd

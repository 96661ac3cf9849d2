// kernels.cpp  Compiles the kernels once an instruction set, and lists their tables, best first.
#include "simd/kernels.hpp"

// Sums are arrays of vectors, which scalable vectors cannot be: 64-bit Arm runs NEON.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#define HWY_TARGET_INCLUDE "simd/kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "simd/kernel_tables.hpp"

// Sums stay in registers only when the loops over them are gone.
#ifndef SINEW_UNROLL
#ifdef __clang__
#define SINEW_UNROLL _Pragma("clang loop unroll(full)")
#else
#define SINEW_UNROLL _Pragma("GCC unroll 16")
#endif
#endif

// In this order: each needs the ones before it.
// clang-format off
#include "simd/vectors-inl.hpp"
#include "simd/state-inl.hpp"
#include "simd/activation-inl.hpp"
#include "simd/aggregate-inl.hpp"
#include "simd/product-inl.hpp"
#include "simd/layer-inl.hpp"
#include "simd/carry-inl.hpp"
#include "simd/rows-inl.hpp"
#include "simd/skin-inl.hpp"
// clang-format on

namespace sinew::simd::HWY_NAMESPACE {

constexpr Kernels kKernels = {
    .target = HWY_TARGET,
    .fused = HWY_NATIVE_FMA != 0,
    .aggregate = aggregate,
    .layer_cells = layer_cells,
    .layer_output = layer_output,
    .carry = carry,
    .dot_rows = dot_rows,
    .add_rows = add_rows,
    .skin = skin,
    .sigmoid = sigmoid,
    .tanh = tanh,
};

}  // namespace sinew::simd::HWY_NAMESPACE

#if HWY_ONCE
namespace sinew::simd {

std::span<const Kernels* const> compiled_kernels() noexcept {
  static const Kernels* const tables[] = {HWY_CHOOSE_TARGET_LIST(kKernels), HWY_CHOOSE_FALLBACK(kKernels)};
  return tables;
}

size_t tile_floats(uint32_t padded) noexcept {
  return kTileRows * 4 * kBlock + 3 * kRangeNodes * static_cast<size_t>(padded);
}

}  // namespace sinew::simd
#endif

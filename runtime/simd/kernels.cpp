// kernels.cpp  Compiles the kernels once an instruction set, and lists their tables, best first.
#include "simd/kernels.hpp"

#include <cstring>
#include <limits>
#include <utility>

#include "simd/targets.hpp"
#define HWY_TARGET_INCLUDE "simd/kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

// In this order: each needs the ones before it.
// clang-format off
#include "simd/vectors-inl.hpp"
#include "simd/state-inl.hpp"
#include "simd/tanh-inl.hpp"
#include "simd/activation-inl.hpp"
#include "simd/aggregate-inl.hpp"
#include "simd/product-inl.hpp"
#include "simd/layer-inl.hpp"
#include "simd/narrow-inl.hpp"
#include "simd/mlp-inl.hpp"
#include "simd/carry-inl.hpp"
#include "simd/rows-inl.hpp"
#include "simd/skin-inl.hpp"
#include "simd/hold-inl.hpp"
#include "simd/three-inl.hpp"
#include "simd/vector3-inl.hpp"
#include "simd/bend-inl.hpp"
#include "simd/turn-inl.hpp"
#include "simd/pose-inl.hpp"
// clang-format on

namespace sinew::simd::HWY_NAMESPACE {

extern const RodKernels kRodKernels;            // rod_kernels.cpp
extern const RodTouchKernels kRodTouchKernels;  // rod_touch_kernels.cpp
extern const RodForceKernels kRodForceKernels;  // the same
extern const SurfaceWalks kSurfaceWalks;        // surface_walk_kernels.cpp

constexpr Kernels kKernels = {
    .target = HWY_TARGET,
    .fused = HWY_NATIVE_FMA != 0,
    .aggregate = aggregate_rows<float>,
    .layer_cells = layer_cells<LayerJob>,
    .layer_output = layer_output<LayerJob>,
    .aggregate_planes = aggregate_planes,
    .narrow_cells = narrow_cells,
    .narrow_output = narrow_output,
    .mlp = mlp,
    .carry = carry,
    .add_rows = add_rows,
    .skin = skin,
    .hold_columns = hold_columns,
    .share_bend = share_bend,
    .turn = turn,
    .turn_back = turn_back,
    .warp = warp,
    .pose_frames = pose_frames,
    .sigmoid = sigmoid<FineTanh>,
    .tanh = tanh<FineTanh>,
    .rods = &kRodKernels,
    .rod_touches = &kRodTouchKernels,
    .rod_forces = &kRodForceKernels,
    .surface_walks = &kSurfaceWalks,
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

size_t mlp_floats(uint32_t widest) noexcept {
  return kTileRows * pack::kPanel + 2 * kRangeNodes * static_cast<size_t>(widest);
}

}  // namespace sinew::simd
#endif

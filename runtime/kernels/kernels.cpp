// kernels.cpp  Compiles the kernels once an instruction set, and lists their tables, best first.
#include "kernels/kernels.hpp"

#include <cstring>
#include <limits>
#include <utility>

#include "kernels/targets.hpp"
#define HWY_TARGET_INCLUDE "kernels/kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

// In this order: each needs the ones before it.
// clang-format off
#include "kernels/vectors-inl.hpp"
#include "kernels/network/state-inl.hpp"
#include "kernels/tanh-inl.hpp"
#include "kernels/network/activation-inl.hpp"
#include "kernels/network/aggregate-inl.hpp"
#include "kernels/network/product-inl.hpp"
#include "kernels/network/layer-inl.hpp"
#include "kernels/network/narrow-inl.hpp"
#include "kernels/network/mlp-inl.hpp"
#include "kernels/surface/carry-inl.hpp"
#include "kernels/surface/rows-inl.hpp"
#include "kernels/surface/skin-inl.hpp"
#include "kernels/surface/hold-inl.hpp"
#include "kernels/three-inl.hpp"
#include "kernels/vector3-inl.hpp"
#include "kernels/surface/bend-inl.hpp"
#include "kernels/surface/turn-inl.hpp"
#include "kernels/surface/pose-inl.hpp"
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

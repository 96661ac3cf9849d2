// surface_walk_kernels.cpp  Compiles the walks through a surface's tree once an instruction set; kernels.cpp
// puts them into its tables.
#include "kernels/surface/surface_walk.hpp"

#include <algorithm>

#include "kernels/targets.hpp"
#define HWY_TARGET_INCLUDE "kernels/surface/surface_walk_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

// In this order: each needs the ones before it.
// clang-format off
#include "kernels/three-inl.hpp"
#include "kernels/surface/surface_walk-inl.hpp"
// clang-format on

namespace sinew::simd::HWY_NAMESPACE {

extern const SurfaceWalks kSurfaceWalks;
const SurfaceWalks kSurfaceWalks = {.nearest = surface_nearest, .near_sweep = surface_near_sweep};

}  // namespace sinew::simd::HWY_NAMESPACE

// layer_kernels.cpp  Compiles the layers in halves and bytes once an instruction set.
#include "baker/research/precision/layer_kernels.hpp"

#include <cstring>
#include <limits>
#include <utility>

#include "kernels/targets.hpp"
#define HWY_TARGET_INCLUDE "baker/research/precision/layer_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#if HWY_ARCH_ARM_A64 && defined(__linux__)
#include <sys/auxv.h>
#endif

// In this order: each needs the ones before it.
// clang-format off
#include "kernels/vectors-inl.hpp"
#include "kernels/network/state-inl.hpp"
#include "baker/research/precision/half_state-inl.hpp"
#include "kernels/tanh-inl.hpp"
#include "kernels/network/activation-inl.hpp"
#include "kernels/network/aggregate-inl.hpp"
#include "kernels/network/product-inl.hpp"
#include "kernels/network/layer-inl.hpp"
#include "baker/research/precision/dot-inl.hpp"
#include "baker/research/precision/int8_layer-inl.hpp"
// clang-format on

namespace sinew::simd::HWY_NAMESPACE {

template <class X, class T>
constexpr baker::LayerPasses<LayerJobOf<X, T>> kPasses = {layer_cells<LayerJobOf<X, T>>,
                                                          layer_output<LayerJobOf<X, T>>};

template <class Dot>
constexpr baker::LayerKernels layers_with(bool (*runs)()) {
  return {.target = HWY_TARGET,
          .runs = runs,
          .first = kPasses<float, Half>,
          .hidden = kPasses<Half, Half>,
          .last = kPasses<Half, float>,
          .int8_first = {byte_layer_cells<Dot, float>, byte_layer_output<Dot, float>},
          .int8_hidden = {byte_layer_cells<Dot, Half>, byte_layer_output<Dot, Half>},
          .coarse_sigmoid = sigmoid<CoarseTanh>,
          .coarse_tanh = tanh<CoarseTanh>};
}

constexpr baker::LayerKernels kLayerKernels = layers_with<BasicDot>(nullptr);
#ifdef SINEW_FAST_DOT
#undef SINEW_FAST_DOT
constexpr baker::LayerKernels kFastDotLayerKernels = layers_with<FastDot>(has_fast_dot);
#endif

}  // namespace sinew::simd::HWY_NAMESPACE

#if HWY_ONCE
namespace sinew::simd {

// Null where a target was not compiled.
static constexpr const baker::LayerKernels* kCompiledLayers[] = {
#if HWY_TARGETS & HWY_AVX3
    &N_AVX3::kFastDotLayerKernels,
#elif (HWY_TARGETS & HWY_NEON) && HWY_ARCH_ARM_A64 && defined(__linux__)
    &N_NEON::kFastDotLayerKernels,
#endif
    HWY_CHOOSE_TARGET_LIST(kLayerKernels), HWY_CHOOSE_FALLBACK(kLayerKernels)};

}  // namespace sinew::simd

namespace sinew::baker {

std::vector<const LayerKernels*> layer_kernels() {
  std::vector<const LayerKernels*> out;
  for (const LayerKernels* table : simd::kCompiledLayers) {
    const bool is_active = table != nullptr && table->target == simd::kernels().target;
    if (is_active && (table->runs == nullptr || table->runs())) out.push_back(table);
  }
  return out;
}

}  // namespace sinew::baker
#endif

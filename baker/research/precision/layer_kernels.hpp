// layer_kernels.hpp  Layers of an Alt-ConvLSTM in halves and bytes: a table of functions an instruction set.
//
// They are the runtime's layers (kernels/network/layer-inl.hpp) compiled for other states, and layers whose
// products are of bytes (int8_layer-inl.hpp). Targets with fused multiply-adds give the same bits.
#pragma once
#include <cstdint>
#include <vector>

#include "baker/research/precision/half.hpp"
#include "kernels/kernels.hpp"

namespace sinew::baker {

// What a hidden layer's products need to be those of bytes; layouts as pack/format.hpp has them at
// kInt8Weights.
struct Int8Layer {
  const int8_t* w = nullptr;
  const int8_t* w_o = nullptr;  // of P y, gate o
  const int32_t* sums = nullptr;
  const float* scale = nullptr;
  const float* per_unit = nullptr;  // [depth]
  uint32_t depth = 0;  // of what is quantised: x, x again with w_s, h, y, each padded; x only if of halves
};

// An x of floats, the input layer's, is multiplied in floats.
template <class X>
struct Int8Job : simd::LayerJobOf<X, Half> {
  Int8Layer int8{};
};

// As simd::Kernels has them: layer_cells and layer_output.
template <class Job>
struct LayerPasses {
  void (*cells)(const Job& job, uint32_t first, uint32_t last);
  void (*output)(const Job& job, uint32_t first, uint32_t last);
};

struct LayerKernels {
  int64_t target;  // Highway's bit
  bool (*runs)();  // whether this processor has what it needs beyond that, or null: nothing
  LayerPasses<simd::LayerJobOf<float, Half>> first;
  LayerPasses<simd::LayerJobOf<Half, Half>> hidden;
  LayerPasses<simd::LayerJobOf<Half, float>> last;
  LayerPasses<Int8Job<float>> int8_first;
  LayerPasses<Int8Job<Half>> int8_hidden;
  // Of `count` floats: what int8 layers use in the place of simd::Kernels' own.
  void (*coarse_sigmoid)(const float* x, size_t count, float* out);
  void (*coarse_tanh)(const float* x, size_t count, float* out);
};

// Those of the runtime's active instruction set that this processor runs, best first: with dot products of
// bytes, where it has them, then without; both give the same bits. Never empty.
std::vector<const LayerKernels*> layer_kernels();

}  // namespace sinew::baker

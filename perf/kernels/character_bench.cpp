// character_bench.cpp  What a character of 7,000 vertices in 6 regions of 40 control nodes and 32 modes costs
// beside its network, every tick or every frame.
#include <cmath>

#include "perf/kernels/bench_data.hpp"

namespace sinew::perf {
namespace {

constexpr uint32_t kRegions = 6, kNodes = 40, kModes = 32, kVertices = 7000, kJoints = 60;

// Displacements of 40 nodes carried to a region's vertices.
void carry(benchmark::State& state) {
  const size_t stride = simd::pad_to_block(kVertices / kRegions);
  const Floats weights = random_floats(kNodes * stride * kRegions, 0.05f);
  Floats displacement = random_floats(kNodes * 3 * kRegions, 0.01f), out(3 * stride);
  for (auto _ : state) {
    for (uint32_t r = 0; r < kRegions; ++r) {
      const float* matrix = const_cast<Floats&>(weights).data() + r * kNodes * stride;
      simd::kernels().carry(matrix, kNodes, stride, displacement.data() + r * kNodes * 3, out.data());
    }
    benchmark::ClobberMemory();
  }
  report(state, 2e-6 * 3 * kNodes * static_cast<double>(stride) * kRegions, simd::active_isa());
}
BENCHMARK(carry)->Name("carry_7000_vertices")->Unit(benchmark::kMicrosecond);

// Linear blend skinning, one to four influences a vertex.
void skin(benchmark::State& state) {
  std::vector<pack::SkinRecord> skins(kVertices);
  double influences = 0;
  for (uint32_t v = 0; v < kVertices; ++v) {
    const uint32_t count = 1 + v % 4;
    influences += count;
    for (uint32_t i = 0; i < count; ++i) {
      skins[v].joint[i] = static_cast<uint16_t>((v / 100 + i) % kJoints);
      skins[v].weight[i] = 1 / static_cast<float>(count);
    }
  }
  Floats matrices = random_floats(kJoints * 12, 1), points = random_floats(kVertices * 3, 1),
         out(kVertices * 3);
  for (auto _ : state) {
    simd::kernels().skin({points.data(), 12, skins[0].joint, skins[0].weight, sizeof(pack::SkinRecord),
                          matrices.data(), out.data(), 12, kVertices});
    benchmark::ClobberMemory();
  }
  report(state, 2e-6 * 12 * (influences + kVertices), simd::active_isa());
}
BENCHMARK(skin)->Name("skin_7000_vertices")->Unit(benchmark::kMicrosecond);

// A tick's four products of the modal base, tissue/modes/modal_base.cpp: response, shape, project, turn.
void modal_products(benchmark::State& state) {
  constexpr uint32_t kFloats = kNodes * 3;
  constexpr size_t kPadded = simd::pad_to_block(kFloats), kPaddedModes = simd::pad_to_block(kModes);
  constexpr size_t kOfRegion = 2 * kModes * kPadded + kFloats * (kPadded + 2 * kPaddedModes);
  Floats matrices = random_floats(kRegions * kOfRegion, 0.1f), x = random_floats(kPadded, 1),
         out(kPadded + kPaddedModes);
  for (auto _ : state) {
    const float* m = matrices.data();
    const auto add = [&](uint32_t count, size_t stride) {
      simd::kernels().add_rows(std::exchange(m, m + count * stride), count, stride, x.data(), out.data());
    };
    for (uint32_t region = 0; region < kRegions; ++region) {
      add(kFloats, kPadded + kPaddedModes);
      add(kModes, kPadded);
      add(kFloats, kPaddedModes);
      add(kModes, kPadded);
    }
    benchmark::ClobberMemory();
  }
  report(state, 2e-6 * kRegions * kOfRegion, simd::active_isa());
}
BENCHMARK(modal_products)->Name("modal_products_240_nodes")->Unit(benchmark::kMicrosecond);

// A vector of the widest layer's gates: what the step spends on activations.
void activations(benchmark::State& state) {
  constexpr size_t kCount = 4096;
  Floats x = random_floats(kCount, 4), out(kCount);
  for (auto _ : state) {
    simd::kernels().sigmoid(x.data(), kCount, out.data());
    simd::kernels().tanh(x.data(), kCount, out.data());
    benchmark::ClobberMemory();
  }
  report(state, 2e-6 * kCount, simd::active_isa());
}
BENCHMARK(activations)->Name("activations_8192")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf

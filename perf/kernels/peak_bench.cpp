// peak_bench.cpp  The yardsticks: what this core does when nothing but fused multiply-adds, or nothing but
// int8 dot products, run.
#include "perf/kernels/bench_data.hpp"
#include "perf/kernels/fma_peak.hpp"

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace sinew::perf {
namespace {

void fma_peak(benchmark::State& state) {
  float sink = 0;
  double operations = 0;
  for (auto _ : state) operations = run_fma(200'000, &sink);
  benchmark::DoNotOptimize(sink);
  report(state, operations * 1e-6, simd::active_isa());
}
BENCHMARK(fma_peak)->Unit(benchmark::kMicrosecond);

#ifdef __x86_64__

// As run_fma, with unsigned times signed bytes, four to a 32-bit sum.
__attribute__((target("avx512f,avx512vnni"))) double run_vnni(uint64_t rounds, int* sink) {
  __m512i sum[12];
  for (int i = 0; i < 12; ++i) sum[i] = _mm512_set1_epi32(*sink + i);
  const __m512i x = _mm512_set1_epi8(static_cast<char>(*sink + 3)), w = _mm512_set1_epi8(5);
  for (uint64_t round = 0; round < rounds; ++round) {
#pragma GCC unroll 12
    for (int i = 0; i < 12; ++i) sum[i] = _mm512_dpbusd_epi32(sum[i], x, w);
  }
  for (int i = 1; i < 12; ++i) sum[0] = _mm512_xor_si512(sum[0], sum[i]);
  *sink = _mm512_reduce_add_epi32(sum[0]);
  return static_cast<double>(rounds) * 12 * 64 * 2;
}

void int8_peak(benchmark::State& state) {
  if (!__builtin_cpu_supports("avx512vnni")) return state.SkipWithError("this processor has no AVX-512 VNNI");
  int sink = 0;
  double operations = 0;
  for (auto _ : state) operations = run_vnni(100'000, &sink);
  benchmark::DoNotOptimize(sink);
  report(state, operations * 1e-6, "vnni");
}
BENCHMARK(int8_peak)->Unit(benchmark::kMicrosecond);

#endif

}  // namespace
}  // namespace sinew::perf

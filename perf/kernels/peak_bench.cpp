// peak_bench.cpp  The yardsticks: what this core does when nothing but fused multiply-adds, or nothing but
// int8 dot products, run.
#include "perf/kernels/bench_data.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perf/kernels/peak_bench.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace sinew::perf::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Twelve chains: more than two FMA ports x four or five cycles of latency, fewer than sixteen registers. They
// start differently, or the compiler would make them one. Returns the operations done.
double run_fma(uint64_t rounds, float* sink) {
  const hn::ScalableTag<float> d;
  const auto factor = hn::Set(d, 0.999f);
  const auto term = hn::Set(d, 0.001f);
  const auto from = [&](float start) HWY_ATTR { return hn::Set(d, *sink + start); };
  auto a = from(1), b = from(2), c = from(3), e = from(4), f = from(5), g = from(6);
  auto h = from(7), i = from(8), j = from(9), k = from(10), l = from(11), m = from(12);
  for (uint64_t round = 0; round < rounds; ++round) {
    a = hn::MulAdd(a, factor, term), b = hn::MulAdd(b, factor, term), c = hn::MulAdd(c, factor, term);
    e = hn::MulAdd(e, factor, term), f = hn::MulAdd(f, factor, term), g = hn::MulAdd(g, factor, term);
    h = hn::MulAdd(h, factor, term), i = hn::MulAdd(i, factor, term), j = hn::MulAdd(j, factor, term);
    k = hn::MulAdd(k, factor, term), l = hn::MulAdd(l, factor, term), m = hn::MulAdd(m, factor, term);
  }
  const auto sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(hn::Add(f, g), hn::Add(h, i)));
  *sink = hn::GetLane(hn::Add(sum, hn::Add(hn::Add(j, k), hn::Add(l, m))));
  return static_cast<double>(rounds) * 12 * 2 * static_cast<double>(hn::Lanes(d));
}

}  // namespace sinew::perf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#if HWY_ARCH_X86
#include <immintrin.h>
#endif

namespace sinew::perf {
namespace {

HWY_EXPORT(run_fma);

void fma_peak(benchmark::State& state) {
  float sink = 0;
  double operations = 0;
  for (auto _ : state) operations = HWY_DYNAMIC_DISPATCH(run_fma)(200'000, &sink);
  benchmark::DoNotOptimize(sink);
  report(state, operations * 1e-6, simd::active_isa());
}
BENCHMARK(fma_peak)->Unit(benchmark::kMicrosecond);

#if HWY_ARCH_X86

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
#endif

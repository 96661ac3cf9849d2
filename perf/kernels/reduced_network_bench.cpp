// reduced_network_bench.cpp  One step of Alt-ConvLSTM in fp16 and int8.
#include "baker/pack/network/int8_layout.hpp"
#include "baker/research/precision/reduced_network.hpp"
#include "perf/kernels/run_steps.hpp"

namespace sinew::perf {
namespace {

struct RandomReducedNetwork {
  RandomReducedNetwork(const NetworkShape& shape, pack::Precision precision) : floats(shape) {
    floats.record.precision = precision;
    if (precision == pack::Precision::kInt8) make_int8();
  }
  baker::ReducedNetwork view() {
    return {floats.view(), {int8_weights.data(), int8_sums.data(), int8_scales.data()}};
  }
  // Bytes of any value, scaled so that gates stay near one; the sums are not theirs, which costs no time.
  void make_int8() {
    size_t bytes = 0, sums = 0, numbers = 0;
    for (size_t l = 0; l + 1 < floats.layers.size(); ++l) {
      const baker::Int8Extent extent = baker::int8_extent(floats.layers[l], l == 0);
      bytes += extent.weights, sums += extent.sums, numbers += extent.scales;
    }
    int8_weights = Aligned<int8_t>(bytes);
    int8_sums = Aligned<int32_t>(sums);
    int8_scales = random_floats(numbers, 1e-3f);
    for (size_t i = 0; i < bytes; ++i) int8_weights[i] = static_cast<int8_t>(i % 255 - 127);
    for (size_t i = 0; i < numbers; ++i) int8_scales[i] = std::abs(int8_scales[i]);
  }

  RandomNetwork floats;
  Floats int8_scales{0};
  Aligned<int8_t> int8_weights{0};
  Aligned<int32_t> int8_sums{0};
};

void run_reduced(benchmark::State& state, const NetworkShape& shape, pack::Precision precision) {
  RandomReducedNetwork network(shape, precision);
  run_steps(state, shape, network.view());
}

BENCHMARK_CAPTURE(run_reduced, paper_fp16, paper_shape(), pack::Precision::kHalfStates)
    ->Name("alt_conv_lstm_fp16_paper")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_reduced, paper_int8, paper_shape(), pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_paper")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_reduced, paper_int8_in_cache, NetworkShape{9, {32, 64, 128, 64, 32, 3}, false, 15, 10},
                  pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_paper_150_vertices")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_reduced, creature_fp16, creature_shape(), pack::Precision::kHalfStates)
    ->Name("alt_conv_lstm_fp16_creature")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_reduced, creature_int8, creature_shape(), pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_creature")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_reduced, wide_fp16, wide_shape(), pack::Precision::kHalfStates)
    ->Name("alt_conv_lstm_fp16_wide")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_reduced, wide_int8, wide_shape(), pack::Precision::kInt8)
    ->Name("alt_conv_lstm_int8_wide")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf

// chain_bench.cpp  Networks of chains of dense layers: DeepEmulator's on a body of 1,468 vertices, and
// COPINGNet's on a head of 1,000 strands.
#include "perf/kernels/chain_data.hpp"
#include "rods/start/coping_net.hpp"
#include "tissue/network/deep_emulator.hpp"

namespace sinew::perf {
namespace {

// The chains alone, each neighbour through all of beta: the products of onednn_sgemm_deep_emulator, and tanh.
void deep_emulator_chains(benchmark::State& state) {
  RandomChains network(deep_emulator_record());
  const std::vector<ChainProducts> chains = deep_emulator_products();
  constexpr size_t kStride = pack::kDeepWidest;
  Floats x = random_floats(kPatches * kNeighbours * pack::kDeepWidest, 1), out(kPatches * kNeighbours * 128),
         scratch(simd::mlp_floats(pack::kDeepWidest));
  for (auto _ : state) {
    for (uint32_t c = 0; c < chains.size(); ++c) {
      simd::MlpJob job = network.chain(c, out.data(), scratch.data());
      job.parts[job.part_count++] = {x.data(), kStride, static_cast<uint32_t>(chains[c].shapes[0].depth),
                                     nullptr};
      job.between = simd::Pointwise::kTanh;
      simd::kernels().mlp(job, 0, chains[c].rows);
    }
    benchmark::ClobberMemory();
  }
  report(state, chain_mflop(chains), simd::active_isa());
}
BENCHMARK(deep_emulator_chains)->Name("deep_emulator_chains")->Unit(benchmark::kMicrosecond);

// The whole step: patches put together, sums, and what is linear done once a node. Its operations are those
// that it does.
void deep_emulator(benchmark::State& state) {
  RandomChains network(deep_emulator_record());
  std::vector<uint32_t> rows = {0}, columns;
  for (uint32_t i = 0; i < kPatches; ++i) {
    for (uint32_t k = 1; k <= kNeighbours; ++k) columns.push_back((i + k * k * 7) % kPatches);
    rows.push_back(static_cast<uint32_t>(columns.size()));
  }
  Floats positions = random_floats(kPatches * 3 * 7, 0.5f), next(kPatches * 3),
         scratch(tissue::deep_emulator_scratch_floats());
  const std::vector<uint8_t> constrained(kPatches);
  const auto at = [&](size_t k) { return positions.data() + k * kPatches * 3; };
  for (auto _ : state) {
    tissue::deep_emulator_step({network.layers, network.weights.data()}, {rows.data(), columns.data()},
                               {at(0), at(1), at(2), at(3), at(4), at(5), at(6), constrained.data()}, 0,
                               kPatches, next.data(), scratch.data());
    benchmark::ClobberMemory();
  }
  // Multiply-adds of a node: alpha, the centre in beta, beta's last layer, gamma; of a neighbour: the rest.
  constexpr double kNode = 18 * 64 + 4 * 64 * 64 + 15 * 128 + 128 * 128 + 4 * 192 * 192 + 192 * 3,
                   kEdge = 22 * 128 + 3 * 128 * 128;
  report(state, 2e-6 * kPatches * (kNode + kNeighbours * kEdge), simd::active_isa());
}
BENCHMARK(deep_emulator)->Name("deep_emulator_step")->Unit(benchmark::kMicrosecond);

// Strands of 16 segments, evaluated some at a time.
struct Strands {
  static constexpr uint32_t kCount = 1000, kSegments = 16;
  Strands() : rows(kNodes + 1), ends(2 * size_t{kEdges}), ones(ends.size()) {
    for (uint32_t s = 0; s < kCount; ++s) {
      for (uint32_t k = 0; k + 1 < kSegments; ++k) {
        senders.push_back(s * kSegments + k);
        receivers.push_back(s * kSegments + k + 1);
      }
    }
    const Status status = rods::link_rods(kNodes, senders, receivers, rows, ends, ones);
    if (!status.ok()) std::abort();
  }
  rods::RodGraph view() const {
    return {kNodes, kEdges, senders.data(), receivers.data(), rows.data(), ends.data(), ones.data()};
  }
  static constexpr uint32_t kNodes = kCount * kSegments, kEdges = kCount * (kSegments - 1);
  std::vector<uint32_t> senders, receivers, rows, ends;
  std::vector<float> ones;
};

void coping_net(benchmark::State& state, uint32_t latent) {
  constexpr uint32_t kRun = 25;  // strands: 400 segments
  RandomChains network(coping_net_record(latent, 5, 2));
  const Strands strands;
  const rods::CopingNet view = {&network.record, network.layers, network.weights.data()};
  Floats nodes = random_floats(Strands::kNodes * 14, 1), edges = random_floats(Strands::kEdges * 5, 1),
         dp(Strands::kNodes * 6), dlambda(Strands::kEdges * 6),
         scratch(rods::coping_net_scratch_floats(view)),
         encodings(rods::rod_encoding_floats(view, Strands::kEdges)),
         planes(rods::coping_net_plane_floats(view, Strands::kNodes, Strands::kEdges));
  rods::encode_rod_edges(view, edges.data(), Strands::kEdges, encodings.data(), scratch.data());
  for (auto _ : state) {
    for (uint32_t s = 0; s < Strands::kCount; s += kRun) {
      const rods::RodRun run = {s * Strands::kSegments, (s + kRun) * Strands::kSegments,
                                s * (Strands::kSegments - 1), (s + kRun) * (Strands::kSegments - 1)};
      rods::run_coping_net(view, strands.view(), run, nodes.data(), encodings.data(), dp.data(),
                           dlambda.data(), planes.data(), scratch.data());
    }
    benchmark::ClobberMemory();
  }
  report(state, coping_net_mflop(network.record, Strands::kNodes, Strands::kEdges), simd::active_isa());
}
BENCHMARK_CAPTURE(coping_net, 8, 8)->Name("coping_net_8_1000_strands")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(coping_net, 16, 16)->Name("coping_net_16_1000_strands")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(coping_net, 32, 32)->Name("coping_net_32_1000_strands")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(coping_net, 64, 64)->Name("coping_net_64_1000_strands")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew::perf

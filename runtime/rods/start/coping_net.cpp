// coping_net.cpp  Walks the blocks of a COPINGNet; the arithmetic is kernels/network/mlp-inl.hpp.
#include "rods/start/coping_net.hpp"

#include <algorithm>

#include "core/status.hpp"
#include "kernels/kernels.hpp"
#include "pack/dense_layout.hpp"

namespace sinew::rods {
namespace {

using simd::kRangeNodes;
using simd::Pointwise;

constexpr size_t kOutWidth = 16;  // of a decoder's row, padded

size_t row_floats(const CopingNet& network) { return simd::pad_to_block(network.record->max_channels); }

// A chain from nothing yet to rows of out. Chains: pack/dense_layout.hpp.
simd::MlpJob chain_job(const CopingNet& network, uint32_t chain, float* out, float* scratch) {
  simd::MlpJob job;
  job.layer_count = network.record->depth + 1;
  job.layers = &network.layers[size_t{chain} * job.layer_count];
  job.weights = network.weights;
  job.widest = static_cast<uint32_t>(row_floats(network));
  job.between = Pointwise::kRelu;
  job.out = out;
  job.out_stride = job.layers[job.layer_count - 1].padded;
  job.scratch = scratch;
  return job;
}

void add_part(const float* rows, size_t stride, uint32_t depth, const uint32_t* index, simd::MlpJob* job) {
  job->parts[job->part_count++] = {rows, stride, depth, index};
}

// What run_coping_net is given.
struct Evaluation {
  const CopingNet& network;
  const RodGraph& graph;
  const RodRun& run;
  float *v, *e;              // [nodes], [edges] [row]
  float *sum, *out, *chain;  // [kRangeNodes][row], [kRangeNodes][kOutWidth], scratch of a chain
  size_t row = row_floats(network);
  uint32_t latent = network.record->max_channels;
};

void update_edges(const Evaluation& at, uint32_t block) {
  simd::MlpJob job = chain_job(at.network, 2 * block + 3, at.e, at.chain);
  add_part(at.e, at.row, at.latent, nullptr, &job);
  add_part(at.v, at.row, at.latent, at.graph.senders, &job);
  add_part(at.v, at.row, at.latent, at.graph.receivers, &job);
  job.adds = true;
  simd::kernels().mlp(job, at.run.first_edge, at.run.last_edge);
}

void update_nodes(const Evaluation& at, uint32_t block) {
  const simd::SparseRows ends = {at.graph.rows, at.graph.edges, at.graph.ones};
  for (uint32_t first = at.run.first_node; first < at.run.last_node; first += kRangeNodes) {
    const uint32_t last = std::min(first + kRangeNodes, at.run.last_node);
    float* v = at.v + first * at.row;
    simd::kernels().aggregate(ends, at.e, at.row, first, last, at.sum);
    simd::MlpJob job = chain_job(at.network, 2 * block + 2, v, at.chain);
    add_part(v, at.row, at.latent, nullptr, &job);
    add_part(at.sum, at.row, at.latent, nullptr, &job);
    job.adds = true;
    simd::kernels().mlp(job, 0, last - first);
  }
}

// Rows first .. last of a plane through a decoder, to out [..][kRodOutputs].
void decode(const Evaluation& at, uint32_t decoder, const float* rows, uint32_t first, uint32_t last,
            float* out) {
  const uint32_t chain = 2 * (at.network.record->blocks + 1) + decoder;
  const pack::DenseRecord& final_layer = at.network.layers.back();
  const float* norms = at.network.weights + final_layer.bias + final_layer.padded;
  for (; first < last; first += kRangeNodes) {
    const uint32_t count = std::min(kRangeNodes, last - first);
    simd::MlpJob job = chain_job(at.network, chain, at.out, at.chain);
    add_part(rows + first * at.row, at.row, at.latent, nullptr, &job);
    job.last = Pointwise::kTanh;
    job.scale = norms + decoder * kOutWidth;
    simd::kernels().mlp(job, 0, count);
    for (uint32_t i = 0; i < count; ++i)
      std::copy_n(at.out + i * kOutWidth, kRodOutputs, out + size_t{first + i} * kRodOutputs);
  }
}

Status refused(size_t edge, const char* what, uint32_t node, uint32_t node_count) {
  return core::make_status(StatusCode::kInvalidArgument,
                           "rods: edge %zu: %s %u of %u nodes; join segments that are there", edge, what,
                           node, node_count);
}

Status check_ends(uint32_t node_count, std::span<const uint32_t> senders,
                  std::span<const uint32_t> receivers) {
  for (size_t edge = 0; edge < senders.size(); ++edge) {
    if (senders[edge] >= node_count) return refused(edge, "sender", senders[edge], node_count);
    if (receivers[edge] >= node_count) return refused(edge, "receiver", receivers[edge], node_count);
    if (senders[edge] == receivers[edge])
      return refused(edge, "sender is its own receiver,", senders[edge], node_count);
  }
  return {};
}

}  // namespace

Status link_rods(uint32_t node_count, std::span<const uint32_t> senders, std::span<const uint32_t> receivers,
                 std::span<uint32_t> rows, std::span<uint32_t> edges, std::span<float> ones) noexcept {
  const size_t ends = 2 * senders.size();
  if (receivers.size() != senders.size() || rows.size() != size_t{node_count} + 1 || edges.size() != ends ||
      ones.size() != ends)
    return core::make_status(StatusCode::kInvalidArgument,
                             "rods: %zu senders, %zu receivers, %zu rows, %zu and %zu ends for %u nodes; "
                             "wanted as many receivers as senders, a row more than nodes, two ends an edge",
                             senders.size(), receivers.size(), rows.size(), edges.size(), ones.size(),
                             node_count);
  if (Status status = check_ends(node_count, senders, receivers); !status.ok()) return status;
  // Counted, summed up, filled from the last edge down: rows end where they start.
  std::ranges::fill(rows, 0u);
  for (const auto list : {senders, receivers})
    for (const uint32_t node : list) ++rows[node];
  for (uint32_t node = 1; node <= node_count; ++node) rows[node] += rows[node - 1];
  for (size_t edge = senders.size(); edge-- > 0;)
    for (const uint32_t node : {senders[edge], receivers[edge]})
      edges[--rows[node]] = static_cast<uint32_t>(edge);
  std::ranges::fill(ones, 1.0f);
  return {};
}

size_t rod_encoding_floats(const CopingNet& network, uint32_t edge_count) noexcept {
  return row_floats(network) * edge_count;
}

void encode_rod_edges(const CopingNet& network, const float* edges, uint32_t edge_count, float* encodings,
                      float* scratch) noexcept {
  simd::MlpJob job = chain_job(network, 1, encodings, scratch);
  add_part(edges, kRodEdgeInputs, kRodEdgeInputs, nullptr, &job);
  simd::kernels().mlp(job, 0, edge_count);
}

size_t coping_net_plane_floats(const CopingNet& network, uint32_t node_count, uint32_t edge_count) noexcept {
  return row_floats(network) * (size_t{node_count} + edge_count);
}

size_t coping_net_scratch_floats(const CopingNet& network) noexcept {
  const size_t row = row_floats(network);
  return kRangeNodes * (row + kOutWidth) + simd::mlp_floats(static_cast<uint32_t>(row));
}

void run_coping_net(const CopingNet& network, const RodGraph& graph, const RodRun& run, const float* nodes,
                    const float* encodings, float* dp, float* dlambda, float* planes,
                    float* scratch) noexcept {
  const size_t row = row_floats(network), edges_at = row * graph.node_count;
  float* out = scratch + kRangeNodes * row;
  const Evaluation at = {network,           graph,   run, planes,
                         planes + edges_at, scratch, out, out + kRangeNodes * kOutWidth};
  simd::MlpJob encoder = chain_job(network, 0, at.v, at.chain);
  add_part(nodes, kRodNodeInputs, kRodNodeInputs, nullptr, &encoder);
  simd::kernels().mlp(encoder, run.first_node, run.last_node);
  std::copy(encodings + run.first_edge * row, encodings + run.last_edge * row, at.e + run.first_edge * row);
  for (uint32_t block = 0; block < network.record->blocks; ++block) {
    update_edges(at, block);
    update_nodes(at, block);
  }
  decode(at, 0, at.v, run.first_node, run.last_node, dp);
  decode(at, 1, at.e, run.first_edge, run.last_edge, dlambda);
}

}  // namespace sinew::rods

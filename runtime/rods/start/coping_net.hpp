// coping_net.hpp  COPINGNet (Shao et al. 2021, Sec. 3.1-3.2): a guess of what a rod solver will find, for all
// strands of a batch at once.
//
//   v = encoder(nodes)   e = encoder(edges)                    the second may be kept: see encode_rod_edges
//   e += edge_m(e, v of its sender, v of its receiver)         for each block m
//   v += node_m(v, sum of the e that it is an end of)
//   dp = norm.node tanh(decoder(v))   dlambda = norm.edge tanh(decoder(e))
//
// Each chain has `depth` hidden layers of `latent` numbers with max(0, x) and one without. A row of nodes is
// x (3), q (4, order x y z w), radius, density, segment length, place along the rod 0..1, three flags of what
// is free; of edges the rest Darboux vector (3), Young's and torsion modulus (normalised as in training). dp
// is dx (3), dphi (3). Rows of a chain are matrix products (kernels/network/mlp-inl.hpp) whose hidden rows
// stay in cache.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "pack/format.hpp"
#include "sinew/status.hpp"

namespace sinew::rods {

inline constexpr uint32_t kRodNodeInputs = 14, kRodEdgeInputs = 5, kRodOutputs = 6;

struct CopingNet {  // views into a pack; trivially copyable
  const pack::NetworkRecord* record = nullptr;
  std::span<const pack::DenseRecord> layers;
  const float* weights = nullptr;
};

// Segments and what joins them. The caller sees to it that each edge stands once, its sender the lower
// segment.
struct RodGraph {
  uint32_t node_count = 0, edge_count = 0;
  const uint32_t* senders = nullptr;    // [edge_count]
  const uint32_t* receivers = nullptr;  // [edge_count]
  // The edges that a node is an end of, in CSR, as link_rods makes it; values are 1.
  const uint32_t* rows = nullptr;   // [node_count + 1]
  const uint32_t* edges = nullptr;  // [2 edge_count]
  const float* ones = nullptr;      // [2 edge_count]
};

// Fills rows [node_count + 1], edges and ones [2 senders.size()]. Refuses lists of different lengths, a
// sender or receiver that is no node, an edge from a node to itself; then nothing is written. Allocates
// nothing.
Status link_rods(uint32_t node_count, std::span<const uint32_t> senders, std::span<const uint32_t> receivers,
                 std::span<uint32_t> rows, std::span<uint32_t> edges, std::span<float> ones) noexcept;

// Of all edges: what encode_rod_edges gives. It depends on rest shape and moduli alone, so it is made once.
size_t rod_encoding_floats(const CopingNet& network, uint32_t edge_count) noexcept;
// edges [edge_count][kRodEdgeInputs]; encodings and scratch 64-byte aligned, scratch as
// coping_net_scratch_floats has it.
void encode_rod_edges(const CopingNet& network, const float* edges, uint32_t edge_count, float* encodings,
                      float* scratch) noexcept;

// Nodes and edges that no edge of the graph leaves: whole rods. Some hundred nodes at a time keep a run's
// rows in L2.
struct RodRun {
  uint32_t first_node, last_node;
  uint32_t first_edge, last_edge;
};

// dp [node_count][kRodOutputs] and dlambda [edge_count][kRodOutputs] of a run, from nodes [node_count]
// [kRodNodeInputs]. `planes`: of the whole graph, 64-byte aligned, nothing in it survives. Runs may be
// evaluated on several threads at once, each with a scratch of its own. The same bits for every cut into runs
// and on every target with FMA. A NaN that a node is fed reaches its dp. Allocates nothing. Cost: some
// latent^2 (blocks (2 depth + 5) + 3 depth) multiply-adds a segment.
size_t coping_net_plane_floats(const CopingNet& network, uint32_t node_count, uint32_t edge_count) noexcept;
size_t coping_net_scratch_floats(const CopingNet& network) noexcept;
void run_coping_net(const CopingNet& network, const RodGraph& graph, const RodRun& run, const float* nodes,
                    const float* encodings, float* dp, float* dlambda, float* planes,
                    float* scratch) noexcept;

}  // namespace sinew::rods

// evaluate_coping_net.cpp  COPINGNet on reference vectors: one evaluation of all their rods.
#include "baker/common/bad_input.hpp"
#include "baker/measure/network/roll_out.hpp"

namespace sinew::baker {
namespace {

std::vector<uint32_t> read_ends(const Safetensors& vectors, const char* name, size_t edges) {
  const std::vector<int32_t> ends = vectors.need(name, {static_cast<long>(edges)}).as_i32();
  return {ends.begin(), ends.end()};  // what is below zero becomes more than there are nodes
}

// A graph with what it points to.
struct Rods {
  Rods(const Safetensors& vectors, uint32_t nodes, uint32_t edges)
      : senders(read_ends(vectors, "senders", edges)),
        receivers(read_ends(vectors, "receivers", edges)),
        rows(nodes + size_t{1}),
        ends(2 * size_t{edges}),
        ones(ends.size()) {
    const Status status = rods::link_rods(nodes, senders, receivers, rows, ends, ones);
    if (!status.ok()) throw BadInput(vectors.path + ": tensors 'senders' and 'receivers': " + status.message);
    graph = {nodes, edges, senders.data(), receivers.data(), rows.data(), ends.data(), ones.data()};
  }
  std::vector<uint32_t> senders, receivers, rows, ends;
  std::vector<float> ones;
  rods::RodGraph graph;
};

void add_errors(const std::vector<float>& values, const std::vector<float>& expected, ErrorSum* error) {
  for (size_t k = 0; k < expected.size(); ++k) error->add(values[k], expected[k]);
}

}  // namespace

RollOutError evaluate_coping_net(const rods::CopingNet& network, const Safetensors& vectors) {
  check_vectors(vectors, "coping_net");
  const std::vector<float> nodes = vectors.need("nodes", {-1, rods::kRodNodeInputs}).as_f32(),
                           edges = vectors.need("edges", {-1, rods::kRodEdgeInputs}).as_f32();
  const auto n = static_cast<uint32_t>(nodes.size() / rods::kRodNodeInputs),
             m = static_cast<uint32_t>(edges.size() / rods::kRodEdgeInputs);
  if (n == 0) throw BadInput(vectors.path + ": holds no nodes, nothing to check; write the vectors again");
  const Rods rods(vectors, n, m);
  const std::vector<float> want_dp = vectors.need("dp", {n, rods::kRodOutputs}).as_f32(),
                           want_dlambda = vectors.need("dlambda", {m, rods::kRodOutputs}).as_f32();
  AlignedFloats encodings(rods::rod_encoding_floats(network, m)),
      planes(rods::coping_net_plane_floats(network, n, m)), scratch(rods::coping_net_scratch_floats(network));
  std::vector<float> dp(want_dp.size()), dlambda(want_dlambda.size());
  rods::encode_rod_edges(network, edges.data(), m, encodings.data(), scratch.data());
  rods::run_coping_net(network, rods.graph, {0, n, 0, m}, nodes.data(), encodings.data(), dp.data(),
                       dlambda.data(), planes.data(), scratch.data());
  ErrorSum error;
  add_errors(dp, want_dp, &error);
  add_errors(dlambda, want_dlambda, &error);
  return error.result(1);
}

}  // namespace sinew::baker

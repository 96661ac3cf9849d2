// aggregate-inl.hpp  Sparse rows times dense rows: what a node hears from its neighbours.
//
//   out[i - first][:] = sum_e values[e] x[columns[e]][:],  e = rows[i] .. rows[i+1] - 1 in order
//   x [nodes][stride], out [last - first][stride], stride a multiple of kBlock, 64-byte aligned
//
// A row of P has about seven entries; the sum of one column block is a chain, and neighbouring blocks hide
// its latency.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

template <size_t kVectors>
HWY_INLINE void aggregate_columns(const SparseRows& graph, uint32_t node, const float* x, size_t stride,
                                  float* out) {
  const Floats d;
  Vector sum[kVectors];
  SINEW_UNROLL
  for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::Zero(d);
  for (uint32_t e = graph.rows[node]; e < graph.rows[node + 1]; ++e) {
    const Vector value = hn::Set(d, graph.values[e]);
    const float* row = x + graph.columns[e] * stride;
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::MulAdd(value, hn::Load(d, row + v * kLanes), sum[v]);
  }
  SINEW_UNROLL
  for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[v], d, out + v * kLanes);
}

HWY_INLINE void aggregate_row(const SparseRows& graph, uint32_t node, const float* x, size_t stride,
                              float* out) {
  const auto body = [&]<size_t kVectors>(size_t j)
                        HWY_ATTR { aggregate_columns<kVectors>(graph, node, x + j, stride, out + j); };
  for_columns(stride, body);
}

void aggregate(const SparseRows& graph, const float* x, size_t stride, uint32_t first, uint32_t last,
               float* out) {
  for (uint32_t i = first; i < last; ++i) aggregate_row(graph, i, x, stride, out + (i - first) * stride);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

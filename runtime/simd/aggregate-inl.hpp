// aggregate-inl.hpp  Sparse rows times dense rows: what a node hears from its neighbours.
//
//   out[i - first][:] = sum_e values[e] x[columns[e]][:],  e = rows[i] .. rows[i+1] - 1 in order
//   x [nodes][stride] floats or halves, out [last - first][stride], stride a multiple of kBlock, 64-byte
//   aligned
//
// A row of P has about seven entries; the sum of one column block is a chain, and neighbouring blocks and
// nodes hide its latency.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

template <size_t kVectors, class T>
HWY_INLINE void aggregate_columns(const SparseRows& graph, const T* x, size_t stride, uint32_t first,
                                  uint32_t last, float* out) {
  const Floats d;
  uint32_t e = graph.rows[first];
  for (uint32_t node = first; node < last; ++node, out += stride) {
    Vector sum[kVectors];
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::Zero(d);
    for (const uint32_t end = graph.rows[node + 1]; e < end; ++e) {
      const Vector value = hn::Set(d, graph.values[e]);
      const T* row = x + graph.columns[e] * stride;
      SINEW_UNROLL
      for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::MulAdd(value, load_state(row + v * kLanes), sum[v]);
    }
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[v], d, out + v * kLanes);
  }
}

// By tiles, so that all columns of a row are read while they are near.
template <class T>
HWY_INLINE void aggregate_rows(const SparseRows& graph, const T* x, size_t stride, uint32_t first,
                               uint32_t last, float* out) {
  for (uint32_t node = first; node < last; node += kTileRows, out += kTileRows * stride) {
    const uint32_t end = HWY_MIN(node + kTileRows, last);
    const auto body = [&]<size_t kVectors>(size_t j)
                          HWY_ATTR { aggregate_columns<kVectors>(graph, x + j, stride, node, end, out + j); };
    for_columns(stride, body);
  }
}

void aggregate(const SparseRows& graph, const float* x, size_t stride, uint32_t first, uint32_t last,
               float* out) {
  aggregate_rows(graph, x, stride, first, last, out);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

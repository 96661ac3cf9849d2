// aggregate-inl.hpp  Sparse rows times dense rows: what a node hears from its neighbours.
//
//   out[i - first][:] = sum_e values[e] x[columns[e]][:],  e = rows[i] .. rows[i+1] - 1 in order
//   x [nodes][stride] floats, or what load_state reads, out [last - first][stride], stride a multiple of
//   kBlock, 64-byte aligned
//
// A row of P has about seven entries; the sum of one column block is a chain, and neighbouring blocks and
// nodes hide its latency.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

template <size_t kVectors, class T, class Take>
HWY_INLINE void aggregate_columns(const SparseRows& graph, const T* x, size_t stride, uint32_t first,
                                  uint32_t last, const Take& take) {
  uint32_t e = graph.rows[first];
  for (uint32_t node = first; node < last; ++node) {
    Vector sum[kVectors];
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::Zero(Floats());
    for (const uint32_t end = graph.rows[node + 1]; e < end; ++e) {
      const Vector value = hn::Set(Floats(), graph.values[e]);
      const T* row = x + graph.columns[e] * stride;
      SINEW_UNROLL
      for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::MulAdd(value, load_state(row + v * kLanes), sum[v]);
    }
    take(node, sum);
  }
}

// Each node's sums go to take(i - first, first column, sums). By tiles, so that all columns of a row are read
// while they are near.
template <class T, class Take>
HWY_INLINE void aggregate_into(const SparseRows& graph, const T* x, size_t stride, uint32_t first,
                               uint32_t last, const Take& take) {
  for (uint32_t node = first; node < last; node += kTileRows) {
    const uint32_t end = HWY_MIN(node + kTileRows, last);
    const auto body = [&]<size_t kVectors>(size_t j) HWY_ATTR {
      const auto take_columns = [&](uint32_t i, const Vector(&sum)[kVectors])
                                    HWY_ATTR { take(i - first, j, sum); };
      aggregate_columns<kVectors>(graph, x + j, stride, node, end, take_columns);
    };
    for_columns(stride, body);
  }
}

template <size_t kVectors>
HWY_INLINE void store_vectors(const Vector (&values)[kVectors], float* out) {
  SINEW_UNROLL
  for (size_t v = 0; v < kVectors; ++v) hn::Store(values[v], Floats(), out + v * kLanes);
}

template <class T>
HWY_INLINE void aggregate_rows(const SparseRows& graph, const T* x, size_t stride, uint32_t first,
                               uint32_t last, float* out) {
  const auto store = [&]<size_t kVectors>(uint32_t i, size_t j, const Vector(&sum)[kVectors])
                         HWY_ATTR { store_vectors(sum, out + i * stride + j); };
  aggregate_into(graph, x, stride, first, last, store);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

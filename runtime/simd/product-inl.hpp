// product-inl.hpp  A tile of rows times several matrices, one sum.
//
//   out[r][j] = start[r][j] + sum_t sum_k terms[t].rows[r][k] terms[t].w[k][j]
//   r < kTileRows, first <= j < last; terms in order, k = 0 .. depth - 1 in order
//   w [depth][w_stride]   out [kTileRows][out_stride]; first and last multiples of kBlock; all but rows
//   64-byte aligned
//
// kTileRows x kWide sums stay in registers through all terms: 24 (AVX-512, NEON) or 12 (AVX2) independent
// chains, where two FMA ports of four cycles latency need eight. Each k costs kWide + kTileRows loads for
// kTileRows * kWide FMA, so the FMA ports are the bound; w is streamed from L2 once a tile.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct RowPointers {
  const float* row[kTileRows];
};

// `count` rows from x on; those beyond them repeat the last, so that a tile that is not full reads what is
// there.
HWY_INLINE RowPointers rows_of(const float* x, size_t stride, uint32_t count) {
  RowPointers rows;
  for (uint32_t r = 0; r < kTileRows; ++r) rows.row[r] = x + HWY_MIN(r, count - 1) * stride;
  return rows;
}

struct Term {
  RowPointers rows;
  uint32_t depth;
  const float* w;
  size_t w_stride;
};

struct Product {
  RowPointers start;
  const Term* terms;
  size_t term_count;
  float* out;
  size_t out_stride;
};

// A function of its own: inlined, the constants of its surroundings take registers from the sums.
template <size_t kVectors>
HWY_NOINLINE void multiply_columns(const Product& job, size_t column) {
  const Floats d;
  Vector sum[kTileRows][kVectors];
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::Load(d, job.start.row[r] + column + v * kLanes);
  }
  for (const Term* term = job.terms; term < job.terms + job.term_count; ++term) {
    const RowPointers x = term->rows;
    const size_t depth = term->depth, w_stride = term->w_stride;
    const float* HWY_RESTRICT w = term->w + column;
    for (size_t k = 0; k < depth; ++k, w += w_stride) {
      Vector weight[kVectors];
      SINEW_UNROLL
      for (size_t v = 0; v < kVectors; ++v) weight[v] = hn::Load(d, w + v * kLanes);
      SINEW_UNROLL
      for (size_t r = 0; r < kTileRows; ++r) {
        const Vector value = hn::Set(d, x.row[r][k]);
        SINEW_UNROLL
        for (size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::MulAdd(value, weight[v], sum[r][v]);
      }
    }
  }
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    float* out = job.out + r * job.out_stride + column;
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[r][v], d, out + v * kLanes);
  }
}

HWY_INLINE void multiply(const Product& job, size_t first, size_t last) {
  const auto body = [&]<size_t kVectors>(size_t j) HWY_ATTR { multiply_columns<kVectors>(job, first + j); };
  for_columns(last - first, body);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

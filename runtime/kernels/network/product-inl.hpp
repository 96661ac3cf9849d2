// product-inl.hpp  A tile of rows times several matrices, one sum.
//
//   out[r][j] = start[r][j] + sum_t sum_k rows_t[r][k] w_t[k][j]
//   r < kTileRows; terms in order, k = 0 .. depth - 1 in order; w [depth][w_stride], 64-byte aligned
//
// kTileRows x kWide sums stay in registers through all terms: 24 (AVX-512, NEON) or 12 (AVX2) independent
// chains, where two FMA ports of four cycles latency need eight. Each k costs kWide + kTileRows loads for
// kTileRows * kWide FMA, so the FMA ports are the bound; w is streamed from L2 once a tile, from end to end
// where its rows are no wider than what a call reads.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// A tile's rows of a plane, one after the other or as `index` names them; a tile that is not full repeats its
// last row.
struct TileRows {
  const float* first;
  size_t stride;
  uint32_t count;
  const uint32_t* index = nullptr;
  const float* row(size_t r) const {
    const size_t at = HWY_MIN(r, count - size_t{1});
    return first + (index ? index[at] : at) * stride;
  }
};

struct Term {
  TileRows rows;
  size_t depth;
  const float* w;
  size_t w_stride;
};

// The columns of one call are kVectors vectors, side by side in w and out, start_step floats apart in start.
struct Product {
  TileRows start;  // at the first column
  const Term* terms;
  size_t term_count;
  size_t start_step;
  float* out;  // [kTileRows][out_stride]
  size_t out_stride;
};

// The first kUsed vectors of each row of sum.
template <size_t kUsed, size_t kVectors>
HWY_INLINE void add_term(const Term& term, size_t column, Vector (&sum)[kTileRows][kVectors]) {
  const Floats d;
  const float* x[kTileRows];
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) x[r] = term.rows.row(r);
  const float* HWY_RESTRICT w = term.w + column;
  for (size_t k = 0; k < term.depth; ++k, w += term.w_stride) {
    Vector weight[kUsed];
    SINEW_UNROLL
    for (size_t v = 0; v < kUsed; ++v) weight[v] = hn::Load(d, w + v * kLanes);
    SINEW_UNROLL
    for (size_t r = 0; r < kTileRows; ++r) {
      const Vector value = hn::Set(d, x[r][k]);
      SINEW_UNROLL
      for (size_t v = 0; v < kUsed; ++v) sum[r][v] = hn::MulAdd(value, weight[v], sum[r][v]);
    }
  }
}

// From `column` of w on; the term behind the last is added to the first kMore vectors. A function of its own:
// inlined, the constants of its surroundings take registers from the sums.
template <size_t kVectors, size_t kMore>
HWY_NOINLINE void multiply(const Product& job, size_t column) {
  const Floats d;
  Vector sum[kTileRows][kVectors];
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    const float* start = job.start.row(r);
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::Load(d, start + v * job.start_step);
  }
  for (size_t t = 0; t < job.term_count; ++t) add_term<kVectors>(job.terms[t], column, sum);
  if constexpr (kMore > 0) add_term<kMore>(job.terms[job.term_count], column, sum);
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[r][v], d, job.out + r * job.out_stride + v * kLanes);
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

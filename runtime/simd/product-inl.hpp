// product-inl.hpp  A tile of rows times a matrix, added to what is there.
//
//   out[r][j] += sum_k x[r][k] w[k][j],  k = 0 .. depth - 1 in order, r < kTileRows, j < columns
//   x [kTileRows][x_stride]   w [depth][w_stride]   out [kTileRows][out_stride]
//   columns a multiple of kBlock; w and out 64-byte aligned
//
// kTileRows x kWide sums live in registers: 24 (AVX-512, NEON) or 12 (AVX2) independent chains, where two FMA
// ports of four cycles latency need eight. Each k costs kWide + kTileRows loads for kTileRows * kWide FMA, so
// the FMA ports are the bound; w is streamed from L2 once a tile.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct Product {
  const float* x;
  size_t x_stride;
  uint32_t depth;
  const float* w;
  size_t w_stride;
  float* out;
  size_t out_stride;
};

template <size_t kVectors>
HWY_INLINE void multiply_columns(const Product& job, size_t column) {
  const Floats d;
  const float* HWY_RESTRICT x = job.x;
  const float* HWY_RESTRICT w = job.w + column;
  float* HWY_RESTRICT out = job.out + column;
  Vector sum[kTileRows][kVectors];
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::Load(d, out + r * job.out_stride + v * kLanes);
  }
  for (uint32_t k = 0; k < job.depth; ++k, w += job.w_stride) {
    Vector weight[kVectors];
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) weight[v] = hn::Load(d, w + v * kLanes);
    SINEW_UNROLL
    for (size_t r = 0; r < kTileRows; ++r) {
      const Vector value = hn::Set(d, x[r * job.x_stride + k]);
      SINEW_UNROLL
      for (size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::MulAdd(value, weight[v], sum[r][v]);
    }
  }
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[r][v], d, out + r * job.out_stride + v * kLanes);
  }
}

HWY_INLINE void add_product(const Product& job, size_t columns) {
  const auto body = [&]<size_t kVectors>(size_t j) HWY_ATTR { multiply_columns<kVectors>(job, j); };
  for_columns(columns, body);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

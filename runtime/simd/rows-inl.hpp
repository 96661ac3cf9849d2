// rows-inl.hpp  A few rows of numbers against one vector: what modes are made of.
//
//   dot_rows   out[k] = sum_i rows[k][i] x[i]
//   add_rows   out[i] = sum_k weights[k] rows[k][i],  k in order
//   rows [count][stride]   x [stride]   stride a multiple of kBlock; rows, x and add_rows' out 64-byte
//   aligned
//
// A dot product has kBlock partial sums, lane i mod kBlock, whatever the vector width, and they are added by
// one tree. Every number of the matrix is read once: at most 64 rows of 128 floats are 32 KB.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

HWY_INLINE float sum_of_block(const float* lanes) {
  float sum[kBlock];
  SINEW_UNROLL
  for (size_t i = 0; i < kBlock; ++i) sum[i] = lanes[i];
  for (size_t half = kBlock / 2; half > 0; half /= 2) {
    for (size_t i = 0; i < half; ++i) sum[i] += sum[i + half];
  }
  return sum[0];
}

void dot_rows(const float* rows, uint32_t count, size_t stride, const float* x, float* out) {
  const Floats d;
  constexpr size_t kVectors = kBlock / kLanes;
  for (uint32_t k = 0; k < count; ++k, rows += stride) {
    Vector sum[kVectors];
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::Zero(d);
    for (size_t i = 0; i < stride; i += kBlock) {
      SINEW_UNROLL
      for (size_t v = 0; v < kVectors; ++v) {
        sum[v] = hn::MulAdd(hn::Load(d, rows + i + v * kLanes), hn::Load(d, x + i + v * kLanes), sum[v]);
      }
    }
    HWY_ALIGN float lanes[kBlock];
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[v], d, lanes + v * kLanes);
    out[k] = sum_of_block(lanes);
  }
}

template <size_t kVectors>
HWY_INLINE void add_row_columns(const float* rows, uint32_t count, size_t stride, const float* weights,
                                float* out) {
  const Floats d;
  Vector sum[kVectors];
  SINEW_UNROLL
  for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::Zero(d);
  for (uint32_t k = 0; k < count; ++k, rows += stride) {
    const Vector weight = hn::Set(d, weights[k]);
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[v] = hn::MulAdd(weight, hn::Load(d, rows + v * kLanes), sum[v]);
  }
  SINEW_UNROLL
  for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[v], d, out + v * kLanes);
}

void add_rows(const float* rows, uint32_t count, size_t stride, const float* weights, float* out) {
  const auto body = [&]<size_t kVectors>(size_t j)
                        HWY_ATTR { add_row_columns<kVectors>(rows + j, count, stride, weights, out + j); };
  for_columns(stride, body);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

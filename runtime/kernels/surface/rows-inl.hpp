// rows-inl.hpp  The weighted sum of a few rows: what modes are made of.
//
//   out[i] = sum_k weights[k] rows[k][i],  k in order
//   rows [count][stride]   out [stride]   stride a multiple of kBlock; rows and out 64-byte aligned
//
// Every number of the matrix is read once, and no sum runs across lanes.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

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

// carry-inl.hpp  Displacements of control nodes carried to the vertices of a region.
//
//   out[axis][v] = sum_n weights[n][v] displacement[n][axis],  n in order
//   weights [nodes][stride]   displacement [nodes][3]   out [3][stride]
//   stride a multiple of kBlock; weights and out 64-byte aligned
//
// Every weight is read once for its three uses: 40 nodes x 2,000 vertices are 320 KB, so the kernel runs at
// the speed of L2.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

template <size_t kVectors>
HWY_INLINE void carry_columns(const float* weights, uint32_t nodes, size_t stride, const float* displacement,
                              float* out) {
  const Floats d;
  Vector sum[3][kVectors];
  SINEW_UNROLL
  for (size_t axis = 0; axis < 3; ++axis) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) sum[axis][v] = hn::Zero(d);
  }
  for (uint32_t n = 0; n < nodes; ++n, weights += stride, displacement += 3) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) {
      const Vector weight = hn::Load(d, weights + v * kLanes);
      SINEW_UNROLL
      for (size_t axis = 0; axis < 3; ++axis) {
        sum[axis][v] = hn::MulAdd(weight, hn::Set(d, displacement[axis]), sum[axis][v]);
      }
    }
  }
  SINEW_UNROLL
  for (size_t axis = 0; axis < 3; ++axis) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) hn::Store(sum[axis][v], d, out + axis * stride + v * kLanes);
  }
}

void carry(const float* weights, uint32_t nodes, size_t stride, const float* displacement, float* out) {
  const auto body = [&]<size_t kVectors>(size_t j) HWY_ATTR {
    carry_columns<kVectors>(weights + j, nodes, stride, displacement, out + j);
  };
  for_columns(stride, body);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

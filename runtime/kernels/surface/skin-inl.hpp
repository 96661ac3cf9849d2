// skin-inl.hpp  Linear blend skinning of points: vertices of a surface, or control nodes.
//
//   M = sum_i weight[i] matrices[joint[i]],  i in order;   out = M (point, 1)
//   shapes and strides: kernels.hpp, SkinJob; nothing need be aligned beyond its own type
//
// The twelve numbers of a matrix are blended as vectors of four, so that the same lanes add in the same order
// everywhere; most vertices have two to four influences, and the first zero weight ends the list.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

using RowTag = hn::CappedTag<float, 4>;
inline constexpr size_t kRowLanes = hn::MaxLanes(RowTag());
inline constexpr size_t kMatrixVectors = 12 / kRowLanes;

template <class T>
HWY_INLINE const T* stepped(const T* start, size_t stride, size_t index) {
  return reinterpret_cast<const T*>(reinterpret_cast<const char*>(start) + stride * index);
}

HWY_INLINE void blend_matrices(const float* matrices, const uint16_t* joints, const float* weights,
                               float* out) {
  const RowTag d;
  hn::Vec<RowTag> sum[kMatrixVectors];
  SINEW_UNROLL
  for (size_t v = 0; v < kMatrixVectors; ++v) sum[v] = hn::Zero(d);
  for (uint32_t i = 0; i < kInfluences && weights[i] > 0; ++i) {
    const auto weight = hn::Set(d, weights[i]);
    const float* m = matrices + joints[i] * size_t{12};
    SINEW_UNROLL
    for (size_t v = 0; v < kMatrixVectors; ++v) {
      sum[v] = hn::MulAdd(weight, hn::LoadU(d, m + v * kRowLanes), sum[v]);
    }
  }
  SINEW_UNROLL
  for (size_t v = 0; v < kMatrixVectors; ++v) hn::Store(sum[v], d, out + v * kRowLanes);
}

void skin(const SkinJob& job) {
  for (uint32_t i = 0; i < job.count; ++i) {
    HWY_ALIGN float m[12];
    blend_matrices(job.matrices, stepped(job.joints, job.skin_stride, i),
                   stepped(job.weights, job.skin_stride, i), m);
    const float* point = stepped(job.points, job.point_stride, i);
    const float x = point[0], y = point[1], z = point[2];
    float* out = const_cast<float*>(stepped(job.out, job.out_stride, i));
    for (size_t r = 0; r < 3; ++r)
      out[r] = (m[4 * r] * x + m[4 * r + 1] * y) + (m[4 * r + 2] * z + m[4 * r + 3]);
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// vector3-inl.hpp  Vectors of three numbers out of and into rows of them, a row a lane.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

using Vector3 = Three<Vector>;

// Row first + i of `count` in lane i, the last one repeated; rows `stride` floats apart.
HWY_INLINE Vector3 load_rows3(const float* rows, size_t stride, uint32_t first, uint32_t count) {
  const Floats d;
  if (stride == 3 && first + kLanes <= count) {
    Vector x, y, z;
    hn::LoadInterleaved3(d, rows + size_t{3} * first, x, y, z);
    return {x, y, z};
  }
  HWY_ALIGN float lanes[3][kLanes];
  for (uint32_t i = 0; i < kLanes; ++i) {
    const float* row = rows + HWY_MIN(first + i, count - 1) * stride;
    for (size_t k = 0; k < 3; ++k) lanes[k][i] = row[k];
  }
  return {hn::Load(d, lanes[0]), hn::Load(d, lanes[1]), hn::Load(d, lanes[2])};
}

HWY_INLINE void store_rows3(const Vector3& v, float* rows, size_t stride, uint32_t first, uint32_t count) {
  const Floats d;
  if (stride == 3 && first + kLanes <= count)
    return hn::StoreInterleaved3(v.x, v.y, v.z, d, rows + size_t{3} * first);
  HWY_ALIGN float lanes[3][kLanes];
  hn::Store(v.x, d, lanes[0]), hn::Store(v.y, d, lanes[1]), hn::Store(v.z, d, lanes[2]);
  for (uint32_t i = 0; i < kLanes && first + i < count; ++i) {
    for (size_t k = 0; k < 3; ++k) rows[(first + i) * stride + k] = lanes[k][i];
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

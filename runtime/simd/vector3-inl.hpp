// vector3-inl.hpp  Vectors of three numbers, as many at a time as there are lanes, out of and into rows of
// them.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Always made from three vectors: the constructor a compiler makes up for none would not be of this target.
struct Vector3 {
  Vector x, y, z;
};

HWY_INLINE Vector dot(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}

HWY_INLINE Vector3 scaled(const Vector3& a, Vector by) {
  return {hn::Mul(a.x, by), hn::Mul(a.y, by), hn::Mul(a.z, by)};
}

// a s + b.
HWY_INLINE Vector3 scaled_and_added(const Vector3& a, Vector s, const Vector3& b) {
  return {hn::MulAdd(a.x, s, b.x), hn::MulAdd(a.y, s, b.y), hn::MulAdd(a.z, s, b.z)};
}

HWY_INLINE Vector3 cross(const Vector3& a, const Vector3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

HWY_INLINE Vector3 chosen(hn::Mask<Floats> yes, const Vector3& a, const Vector3& b) {
  return {hn::IfThenElse(yes, a.x, b.x), hn::IfThenElse(yes, a.y, b.y), hn::IfThenElse(yes, a.z, b.z)};
}

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

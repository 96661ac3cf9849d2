// pose-inl.hpp  What linear blend skinning does to frames: where they are and how they are turned.
//
//   M = sum_i weight[i] matrices[joint[i]];  place = root M (point, 1)
//   turn = root [x y x-cross-y],  x = M_0 / |M_0|,  y = (M_1 - x (x . M_1)) / |.|      (Gram-Schmidt)
// A column shorter than 1e-6 is taken for none: x, or any direction across x, in its stead; so is one that is
// not a number. Blending is that of skin-inl.hpp; all else is worked on with a frame a lane.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct Axes {
  Vector3 x, y, z;  // columns
};

HWY_INLINE Vector3 unit_or(const Vector3& v, const Vector3& otherwise) {
  const Floats d;
  const Vector length = hn::Sqrt(dot(v, v));
  const auto good = hn::Gt(length, hn::Set(d, 1e-6f));
  return choose(good, scaled(hn::Div(hn::Set(d, 1), length), v), otherwise);
}

// Any unit vector across x: in the plane of its two larger coordinates, nearly.
HWY_INLINE Vector3 across(const Vector3& x) {
  const Vector none = hn::Zero(Floats());
  const auto steep = hn::Gt(hn::Abs(x.z), hn::Set(Floats(), 0.9f));
  const Vector3 v = choose(steep, Vector3{none, hn::Neg(x.z), x.y}, Vector3{hn::Neg(x.y), x.x, none});
  return scaled(hn::Div(hn::Set(Floats(), 1), hn::Sqrt(dot(v, v))), v);
}

// Columns 0 to 2 of row-major 3x4 matrices, number k in m[k].
HWY_INLINE Axes axes_of(const Vector (&m)[12]) {
  const Floats d;
  const Vector3 first = {hn::Set(d, 1), hn::Zero(d), hn::Zero(d)}, second = {m[1], m[5], m[9]};
  const Vector3 x = unit_or({m[0], m[4], m[8]}, first);
  const Vector3 y = unit_or(scaled_sum(hn::Neg(dot(x, second)), x, second), across(x));
  return {x, y, cross(x, y)};
}

HWY_INLINE Vector3 rotated(const float* root, const Vector3& v) {
  const auto row = [&](size_t r) HWY_ATTR {
    const Floats d;
    return dot(Vector3{hn::Set(d, root[r]), hn::Set(d, root[r + 1]), hn::Set(d, root[r + 2])}, v);
  };
  return {row(0), row(3), row(6)};
}

HWY_INLINE void load_blended(const SkinJob& job, uint32_t first, Vector (&m)[12]) {
  HWY_ALIGN float lanes[12][kLanes];
  for (uint32_t i = 0; i < kLanes; ++i) {
    const size_t row = HWY_MIN(first + i, job.count - 1);
    HWY_ALIGN float blended[12];
    blend_matrices(job.matrices, stepped(job.joints, job.skin_stride, row),
                   stepped(job.weights, job.skin_stride, row), blended);
    for (size_t k = 0; k < 12; ++k) lanes[k][i] = blended[k];
  }
  for (size_t k = 0; k < 12; ++k) m[k] = hn::Load(Floats(), lanes[k]);
}

void pose_frames(const SkinJob& job, const float* root) {
  const size_t stride = job.out_stride / sizeof(float);
  for (uint32_t first = 0; first < job.count; first += kLanes) {
    Vector m[12];
    load_blended(job, first, m);
    const Vector3 point = load_rows3(job.points, job.point_stride / sizeof(float), first, job.count);
    const auto moved = [&](size_t r) HWY_ATTR {
      return hn::MulAdd(m[r], point.x,
                        hn::MulAdd(m[r + 1], point.y, hn::MulAdd(m[r + 2], point.z, m[r + 3])));
    };
    const Axes axes = axes_of(m);
    const Vector3 x = rotated(root, axes.x), y = rotated(root, axes.y), z = rotated(root, axes.z);
    const Vector3 columns[] = {
        rotated(root, {moved(0), moved(4), moved(8)}), {x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
    for (size_t k = 0; k < 4; ++k) store_rows3(columns[k], job.out + 3 * k, stride, first, job.count);
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

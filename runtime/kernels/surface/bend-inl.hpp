// bend-inl.hpp  Three quarters of a turn, by quaternions and without an angle, of many frames at a time.
//
// Formula, and what becomes of large turns: tissue/frames/node_bend.hpp. Of the turn A = held^T R, a
// quaternion (v, w):
//   w = sqrt(1 + tr A) / 2,  v = vee(A - A^T) / (4 w)
//   the root of a unit quaternion is (v, w + 1) / sqrt(2 + 2 w); twice, it is the fourth part of the turn
// Frames are taken apart into lanes and put together again: the cost is that of moving 21 numbers a frame.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Rotations row-major, number k in r[k]; frame i of a job in lane i, the last is repeated.
HWY_INLINE void load_frames(const BendJob& job, uint32_t first, Vector (&r)[9]) {
  HWY_ALIGN float lanes[9][kLanes];
  for (uint32_t i = 0; i < kLanes; ++i) {
    const float* rotation = job.rotations + HWY_MIN(first + i, job.count - 1) * job.stride;
    for (size_t k = 0; k < 9; ++k) lanes[k][i] = rotation[k];
  }
  for (size_t k = 0; k < 9; ++k) r[k] = hn::Load(Floats(), lanes[k]);
}

// v of a quarter of the turn from held to the frame.
HWY_INLINE Vector3 quarter_turn(const float* held, const Vector (&r)[9]) {
  const Floats d;
  const auto set = [](float value) HWY_ATTR { return hn::Set(Floats(), value); };
  const auto turn = [&](size_t row, size_t c) HWY_ATTR {
    return dot(Vector3{set(held[row]), set(held[3 + row]), set(held[6 + row])},
               Vector3{r[c], r[3 + c], r[6 + c]});
  };
  const Vector one = set(1), two = set(2);
  const Vector trace = hn::Add(turn(0, 0), hn::Add(turn(1, 1), turn(2, 2)));
  const Vector w = hn::Mul(hn::Sqrt(hn::Max(hn::Add(one, trace), hn::Zero(d))), set(0.5f));
  const Vector3 twice = {hn::Sub(turn(2, 1), turn(1, 2)), hn::Sub(turn(0, 2), turn(2, 0)),
                         hn::Sub(turn(1, 0), turn(0, 1))};
  const Vector root = hn::Sqrt(hn::MulAdd(two, w, two));
  const Vector quarter = hn::Sqrt(hn::MulAdd(two, hn::Div(hn::Add(w, one), root), two));
  const Vector faded = hn::Div(hn::Sub(w, set(kBendGone)), set(kBendFading - kBendGone));
  const Vector size = hn::Div(hn::Min(one, faded), hn::Mul(hn::Mul(root, quarter), hn::Mul(set(4), w)));
  const auto told = hn::Gt(w, set(kBendGone));  // false where a frame is not a number
  const Vector3 v = scaled(size, twice);
  return {hn::IfThenElseZero(told, v.x), hn::IfThenElseZero(told, v.y), hn::IfThenElseZero(told, v.z)};
}

// 2 asin(|v|) v / |v| by its series; |v| <= sin(pi / 8).
HWY_INLINE Vector3 rotation_vector(const Vector3& v) {
  const Floats d;
  const Vector s = dot(v, v);
  Vector sum = hn::Set(d, 63.0f / 1408);
  for (const float term : {35.0f / 576, 5.0f / 56, 3.0f / 20, 1.0f / 3, 2.0f})
    sum = hn::MulAdd(sum, s, hn::Set(d, term));
  return scaled(sum, v);
}

// R turned back by (v, w): R (1 + 2 w [b]x + 2 [b]x^2), b = -v.
HWY_INLINE void turn_frame_back(const Vector3& v, Vector (&r)[9]) {
  const Floats d;
  const Vector one = hn::Set(d, 1);
  const Vector w = hn::Sqrt(hn::Sub(one, dot(v, v)));
  const Vector3 b = {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)}, t = scaled(hn::Set(d, 2), b),
                wt = scaled(w, t);
  const Vector xx = hn::Mul(t.x, b.x), yy = hn::Mul(t.y, b.y), zz = hn::Mul(t.z, b.z);
  const Vector xy = hn::Mul(t.x, b.y), xz = hn::Mul(t.x, b.z), yz = hn::Mul(t.y, b.z);
  const Vector3 x = {hn::Sub(one, hn::Add(yy, zz)), hn::Add(xy, wt.z), hn::Sub(xz, wt.y)};  // columns
  const Vector3 y = {hn::Sub(xy, wt.z), hn::Sub(one, hn::Add(xx, zz)), hn::Add(yz, wt.x)};
  const Vector3 z = {hn::Add(xz, wt.y), hn::Sub(yz, wt.x), hn::Sub(one, hn::Add(xx, yy))};
  for (size_t row = 0; row < 9; row += 3) {
    const Vector3 from = {r[row], r[row + 1], r[row + 2]};
    r[row] = dot(from, x), r[row + 1] = dot(from, y), r[row + 2] = dot(from, z);
  }
}

HWY_INLINE void store_frames(const BendJob& job, uint32_t first, const Vector (&r)[9], const Vector3& bend) {
  const Floats d;
  HWY_ALIGN float lanes[12][kLanes];
  for (size_t k = 0; k < 9; ++k) hn::Store(r[k], d, lanes[k]);
  hn::Store(bend.x, d, lanes[9]), hn::Store(bend.y, d, lanes[10]), hn::Store(bend.z, d, lanes[11]);
  for (uint32_t i = 0; i < kLanes && first + i < job.count; ++i) {
    float* rotation = job.rotations + (first + i) * job.stride;
    float* out = job.bends + (first + i) * job.stride;
    for (size_t k = 0; k < 9; ++k) rotation[k] = lanes[k][i];
    for (size_t k = 0; k < 3; ++k) out[k] = lanes[9 + k][i];
  }
}

void share_bend(const BendJob& job) {
  for (uint32_t first = 0; first < job.count; first += kLanes) {
    Vector r[9];
    load_frames(job, first, r);
    const Vector3 v = quarter_turn(job.held, r);
    turn_frame_back(v, r);
    store_frames(job, first, r, rotation_vector(v));
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// activation-inl.hpp  tanh and sigmoid of vectors.
//
//   tanh x    = x P(x^2) / Q(x^2) on |x| <= 9, where it rounds to 1
//   sigmoid x = 1/2 + 1/2 tanh(x/2)
//
// P and Q, of degree 4, come from a Lawson iteration on the relative error, which is 2.1e-8 before rounding;
// all coefficients are positive, so that nothing cancels. Largest errors (every float of 2^-15 <= |x| < 64,
// each sixteenth beyond; with FMA, without): tanh 3.6e-7, 4.0e-7 relative; sigmoid 1.9e-7, 2.2e-7 absolute.
// Never beyond 1 in magnitude; exact at 0; NaN stays NaN. Cost: 8 FMA, 2 mul, 1 div, 4 compares.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// By compare and select, for Min and Max drop a NaN on some targets.
HWY_INLINE Vector bounded(Vector x, Vector bound) {
  x = hn::IfThenElse(hn::Gt(x, bound), bound, x);
  return hn::IfThenElse(hn::Lt(x, hn::Neg(bound)), hn::Neg(bound), x);
}

HWY_INLINE Vector tanh_of(Vector x) {
  const Floats d;
  x = bounded(x, hn::Set(d, 9.0f));
  const Vector s = hn::Mul(x, x);
  Vector p = hn::Set(d, 1.335465375e-8f);
  Vector q = hn::Set(d, 7.776555864e-7f);
  p = hn::MulAdd(p, s, hn::Set(d, 2.060907912e-5f));
  q = hn::MulAdd(q, s, hn::Set(d, 3.285634585e-4f));
  p = hn::MulAdd(p, s, hn::Set(d, 3.495588020e-3f));
  q = hn::MulAdd(q, s, hn::Set(d, 2.587698186e-2f));
  p = hn::MulAdd(p, s, hn::Set(d, 1.338102557e-1f));
  q = hn::MulAdd(q, s, hn::Set(d, 4.671434116e-1f));
  p = hn::MulAdd(p, s, hn::Set(d, 1.0f));
  q = hn::MulAdd(q, s, hn::Set(d, 1.0f));
  // Rounding alone would take a few arguments near 8.5 to the float after 1, and sigmoid below 0.
  return bounded(hn::Div(hn::Mul(x, p), q), hn::Set(d, 1.0f));
}

HWY_INLINE Vector sigmoid_of(Vector x) {
  const Vector half = hn::Set(Floats(), 0.5f);
  return hn::MulAdd(half, tanh_of(hn::Mul(half, x)), half);
}

template <class Function>
HWY_INLINE void map_floats(const float* x, size_t count, float* out, const Function& function) {
  const Floats d;
  size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) hn::StoreU(function(hn::LoadU(d, x + i)), d, out + i);
  HWY_ALIGN float rest[kLanes] = {};
  for (size_t k = 0; i + k < count; ++k) rest[k] = x[i + k];
  hn::Store(function(hn::Load(d, rest)), d, rest);
  for (size_t k = 0; i + k < count; ++k) out[i + k] = rest[k];
}

void sigmoid(const float* x, size_t count, float* out) {
  map_floats(x, count, out, [](Vector v) HWY_ATTR { return sigmoid_of(v); });
}

void tanh(const float* x, size_t count, float* out) {
  map_floats(x, count, out, [](Vector v) HWY_ATTR { return tanh_of(v); });
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

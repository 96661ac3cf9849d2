// tanh-inl.hpp  tanh and sigmoid of a vector of any width.
//
//   tanh x    = x P(x^2) / Q(x^2) on |x| <= b
//   sigmoid x = 1/2 + 1/2 tanh(x/2) = 1/2 + x P(x^2 / 4) / (4 Q(x^2 / 4)) on |x| <= 2 b
//
// FineTanh: P and Q, of degree 4, come from a Lawson iteration on the relative error, which is 2.1e-8 before
// rounding; all coefficients are positive, so that nothing cancels. At the bounds tanh is 1 - 2.4e-7, and no
// rounding below them reaches beyond 1. Largest errors (every float of 2^-15 <= |x| < 64, each sixteenth
// beyond; with FMA, without): tanh 3.6e-7, 4.0e-7 relative; sigmoid 1.9e-7, 2.2e-7 absolute. Never beyond 1
// in magnitude; exact at 0; NaN stays NaN. Cost: 8 FMA, 2 mul, 1 div, 2 min or max; sigmoid 1 FMA more.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// NaN stays NaN: x86's minimum is its second operand where either is NaN; other targets' may drop it.
template <class V>
HWY_INLINE V bounded(V x, V bound) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return hn::Max(hn::Neg(bound), hn::Min(bound, x));
#else
  x = hn::IfThenElse(hn::Gt(x, bound), bound, x);
  return hn::IfThenElse(hn::Lt(x, hn::Neg(bound)), hn::Neg(bound), x);
#endif
}

// A value not yet divided, so that a product of several costs one division.
template <class V>
struct Quotient {
  V over, under;
};

template <class V>
HWY_INLINE V value_of(const Quotient<V>& q) {
  return hn::Div(q.over, q.under);
}

template <class V>
HWY_INLINE Quotient<V> product_of(const Quotient<V>& a, const Quotient<V>& b) {
  return {hn::Mul(a.over, b.over), hn::Mul(a.under, b.under)};
}

// Coefficients of P and Q, the constant term first, and the largest |x|.
struct FineTanh {
  static constexpr float kBound = 8;
  static constexpr float kP[] = {1.0f, 1.338102557e-1f, 3.495588020e-3f, 2.060907912e-5f, 1.335465375e-8f};
  static constexpr float kQ[] = {1.0f, 4.671434116e-1f, 2.587698186e-2f, 3.285634585e-4f, 7.776555864e-7f};
};

// sum_k scale^(k + first) coefficients[k] s^k
template <size_t kCount, class V>
HWY_INLINE V polynomial(const float (&coefficients)[kCount], V s, float scale, size_t first) {
  const auto coefficient = [&](size_t k) HWY_ATTR {
    float value = coefficients[k];
    for (size_t power = 0; power < k + first; ++power) value *= scale;
    return hn::Set(hn::DFromV<V>(), value);
  };
  V sum = coefficient(kCount - 1);
  SINEW_UNROLL
  for (size_t k = 1; k < kCount; ++k) sum = hn::MulAdd(sum, s, coefficient(kCount - 1 - k));
  return sum;
}

// tanh(x) or, halved, tanh(x/2) / 2: powers of two in the coefficients change no rounding.
template <class Curve, bool kHalved, class V>
HWY_INLINE Quotient<V> tanh_quotient(V x) {
  constexpr float kSquare = kHalved ? 0.25f : 1.0f;
  x = bounded(x, hn::Set(hn::DFromV<V>(), kHalved ? 2 * Curve::kBound : Curve::kBound));
  const V s = hn::Mul(x, x);
  const V q = polynomial(Curve::kQ, s, kSquare, 0);
  return {hn::Mul(x, polynomial(Curve::kP, s, kSquare, 1)), q};
}

template <class Curve = FineTanh, class V>
HWY_INLINE Quotient<V> tanh_of(V x) {
  return tanh_quotient<Curve, false>(x);
}

template <class Curve = FineTanh, class V>
HWY_INLINE Quotient<V> sigmoid_of(V x) {
  const Quotient<V> half_tanh = tanh_quotient<Curve, true>(x);
  return {hn::MulAdd(hn::Set(hn::DFromV<V>(), 0.5f), half_tanh.under, half_tanh.over), half_tanh.under};
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

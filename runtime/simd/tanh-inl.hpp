// tanh-inl.hpp  tanh and sigmoid of a vector of any width.
//
//   tanh x    = x P(x^2) / Q(x^2) on |x| <= 8
//   sigmoid x = 1/2 + 1/2 tanh(x/2) = 1/2 + x P(x^2 / 4) / (4 Q(x^2 / 4)) on |x| <= 16
//
// P and Q, of degree 4, come from a Lawson iteration on the relative error, which is 2.1e-8 before rounding;
// all coefficients are positive, so that nothing cancels. At the bounds tanh is 1 - 2.4e-7, and no rounding
// below them reaches beyond 1. Largest errors (every float of 2^-15 <= |x| < 64, each sixteenth beyond; with
// FMA, without): tanh 3.6e-7, 4.0e-7 relative; sigmoid 1.9e-7, 2.2e-7 absolute. Never beyond 1 in magnitude;
// exact at 0; NaN stays NaN. Cost: 8 FMA, 2 mul, 1 div, 2 min or max; sigmoid 1 FMA more.
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

// tanh(x) or, halved, tanh(x/2) / 2: powers of two in the coefficients change no rounding.
template <bool kHalved, class V>
HWY_INLINE Quotient<V> tanh_quotient(V x) {
  constexpr float kSquare = kHalved ? 0.25f : 1.0f;
  const hn::DFromV<V> d;
  const auto coefficient = [](float value, int power) HWY_ATTR {
    for (int k = 0; k < power; ++k) value *= kSquare;
    return hn::Set(hn::DFromV<V>(), value);
  };
  x = bounded(x, hn::Set(d, kHalved ? 16.0f : 8.0f));
  const V s = hn::Mul(x, x);
  V p = coefficient(1.335465375e-8f, 5);
  V q = coefficient(7.776555864e-7f, 4);
  p = hn::MulAdd(p, s, coefficient(2.060907912e-5f, 4));
  q = hn::MulAdd(q, s, coefficient(3.285634585e-4f, 3));
  p = hn::MulAdd(p, s, coefficient(3.495588020e-3f, 3));
  q = hn::MulAdd(q, s, coefficient(2.587698186e-2f, 2));
  p = hn::MulAdd(p, s, coefficient(1.338102557e-1f, 2));
  q = hn::MulAdd(q, s, coefficient(4.671434116e-1f, 1));
  p = hn::MulAdd(p, s, coefficient(1.0f, 1));
  q = hn::MulAdd(q, s, hn::Set(d, 1.0f));
  return {hn::Mul(x, p), q};
}

template <class V>
HWY_INLINE Quotient<V> tanh_of(V x) {
  return tanh_quotient<false>(x);
}

template <class V>
HWY_INLINE Quotient<V> sigmoid_of(V x) {
  const Quotient<V> half_tanh = tanh_quotient<true>(x);
  return {hn::MulAdd(hn::Set(hn::DFromV<V>(), 0.5f), half_tanh.under, half_tanh.over), half_tanh.under};
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

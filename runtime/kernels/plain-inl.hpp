// plain-inl.hpp  Vectors in the order and with the roundings of rods/vector.hpp: no operation is fused.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

template <class V>
HWY_INLINE V plain_dot(const Three<V>& a, const Three<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE V plain_length(const Three<V>& a) {
  return hn::Sqrt(plain_dot(a, a));
}
template <class V>
HWY_INLINE Three<V> plain_sum(V s, const Three<V>& a, const Three<V>& b) {
  return scaled(s, a) + b;
}
template <class V>
HWY_INLINE Three<V> plain_between(const Three<V>& a, const Three<V>& b, V t) {
  return plain_sum(t, b - a, a);
}
template <class V>
HWY_INLINE Three<V> plain_cross(const Three<V>& a, const Three<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
template <class V>
HWY_INLINE Three<V> plain_across(const Three<V>& v, const Three<V>& n) {
  return plain_sum(hn::Neg(plain_dot(v, n)), n, v);
}
}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

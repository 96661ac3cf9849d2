// three-inl.hpp  Vectors of three numbers, as many at a time as there are lanes.
//
// As all of *-inl.hpp, once a target: no include guard.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Always made from three vectors: the constructor a compiler makes up for none would not be of this target.
template <class V>
struct Three {
  V x, y, z;
};
template <class V>
HWY_INLINE Three<V> operator+(const Three<V>& a, const Three<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Three<V> operator-(const Three<V>& a, const Three<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Three<V> scaled(V s, const Three<V>& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
// s a + b
template <class V>
HWY_INLINE Three<V> scaled_sum(V s, const Three<V>& a, const Three<V>& b) {
  return {hn::MulAdd(s, a.x, b.x), hn::MulAdd(s, a.y, b.y), hn::MulAdd(s, a.z, b.z)};
}
// b - s a
template <class V>
HWY_INLINE Three<V> less_scaled(V s, const Three<V>& a, const Three<V>& b) {
  return {hn::NegMulAdd(s, a.x, b.x), hn::NegMulAdd(s, a.y, b.y), hn::NegMulAdd(s, a.z, b.z)};
}
template <class V>
HWY_INLINE V dot(const Three<V>& a, const Three<V>& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}
template <class V>
HWY_INLINE Three<V> cross(const Three<V>& a, const Three<V>& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
template <class V>
HWY_INLINE Three<V> choose(hn::Mask<hn::DFromV<V>> mask, const Three<V>& yes, const Three<V>& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

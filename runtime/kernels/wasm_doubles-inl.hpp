// wasm_doubles-inl.hpp  Double-precision lanes of WebAssembly, which Highway has from 1.1 on alone.
//
// As all of *-inl.hpp, once a target: no include guard.
#if HWY_TARGET == HWY_WASM && !HWY_HAVE_FLOAT64
HWY_BEFORE_NAMESPACE();
namespace hwy::HWY_NAMESPACE {

template <size_t N>
using Doubles = Vec128<double, N>;
template <size_t N>
using DoublesMask = Mask128<double, N>;

template <size_t N>
HWY_API Doubles<N> Set(Simd<double, N, 0>, double t) {
  return {wasm_f64x2_splat(t)};
}
template <size_t N>
HWY_API Doubles<N> Zero(Simd<double, N, 0>) {
  return {wasm_f64x2_splat(0)};
}
template <size_t N>
HWY_API Doubles<N> operator+(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_add(a.raw, b.raw)};
}
template <size_t N>
HWY_API Doubles<N> operator-(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_sub(a.raw, b.raw)};
}
template <size_t N>
HWY_API Doubles<N> operator*(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_mul(a.raw, b.raw)};
}
template <size_t N>
HWY_API Doubles<N> operator/(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_div(a.raw, b.raw)};
}
template <size_t N>
HWY_API Doubles<N> Neg(Doubles<N> v) {
  return {wasm_f64x2_neg(v.raw)};
}
template <size_t N>
HWY_API Doubles<N> Abs(Doubles<N> v) {
  return {wasm_f64x2_abs(v.raw)};
}
template <size_t N>
HWY_API Doubles<N> Sqrt(Doubles<N> v) {
  return {wasm_f64x2_sqrt(v.raw)};
}
template <size_t N>
HWY_API Doubles<N> Min(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_pmin(a.raw, b.raw)};
}
template <size_t N>
HWY_API Doubles<N> Max(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_pmax(a.raw, b.raw)};
}
template <size_t N>
HWY_API DoublesMask<N> operator==(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_eq(a.raw, b.raw)};
}
template <size_t N>
HWY_API DoublesMask<N> operator<(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_lt(a.raw, b.raw)};
}
template <size_t N>
HWY_API DoublesMask<N> operator>(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_gt(a.raw, b.raw)};
}
template <size_t N>
HWY_API DoublesMask<N> operator>=(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_ge(a.raw, b.raw)};
}
template <size_t N>
HWY_API DoublesMask<N> operator<=(Doubles<N> a, Doubles<N> b) {
  return {wasm_f64x2_le(a.raw, b.raw)};
}
template <size_t N>
HWY_API Doubles<N> PromoteTo(Simd<double, N, 0>, Vec128<float, N> v) {
  return {wasm_f64x2_promote_low_f32x4(v.raw)};
}
template <size_t N>
HWY_API Vec128<float, N> DemoteTo(Simd<float, N, 0>, Doubles<N> v) {
  return {wasm_f32x4_demote_f64x2_zero(v.raw)};
}

}  // namespace hwy::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

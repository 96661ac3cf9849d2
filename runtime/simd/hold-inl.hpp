// hold-inl.hpp  Rows of numbers brought to scale and held inside a bound for each column.
//
//   out = clamp(x scale, +-bound), 0 where x scale is not finite;  how many it is not
//   rows [count][stride]   scale, bound [stride]   stride a multiple of kBlock; all 64-byte aligned
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

uint32_t hold_rows(float* rows, uint32_t count, size_t stride, const float* scale, const float* bound) {
  const Floats d;
  size_t held = 0;
  for (uint32_t i = 0; i < count; ++i, rows += stride) {
    for (size_t j = 0; j < stride; j += kLanes) {
      const Vector x = hn::Mul(hn::Load(d, rows + j), hn::Load(d, scale + j)), most = hn::Load(d, bound + j);
      const Vector inside = hn::Min(hn::Max(x, hn::Neg(most)), most);
      const auto finite = hn::IsFinite(x);
      held += hn::CountTrue(d, hn::Or(hn::Not(finite), hn::Ne(inside, x)));
      const Vector out = hn::IfThenElseZero(finite, inside);
      hn::Store(out, d, rows + j);
    }
  }
  return static_cast<uint32_t>(held);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

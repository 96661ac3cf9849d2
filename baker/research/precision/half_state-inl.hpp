// half_state-inl.hpp  Rows of a layer's state kept as IEEE halves: what kernels/network/layer-inl.hpp needs
// of them, before it.
//
// Halves are rounded to nearest, ties to even, subnormal ones and NaN kept, on every target: by instruction
// where there is one, else by the integer arithmetic below, whatever Highway's own fallback does (it
// truncates). Beyond 65520 they are infinite.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

using baker::Half;
using Words = hn::Rebind<uint32_t, Floats>;
using Shorts = hn::Rebind<uint16_t, Floats>;
using Halves = hn::Rebind<hwy::float16_t, Floats>;

#if (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2) || HWY_TARGET == HWY_NEON

HWY_INLINE Vector load_state(const Half* row) {
  return hn::PromoteTo(Floats(), hn::Load(Halves(), reinterpret_cast<const hwy::float16_t*>(row)));
}
HWY_INLINE void store_state(Vector value, Half* row) {
  hn::Store(hn::DemoteTo(Halves(), value), Halves(), reinterpret_cast<hwy::float16_t*>(row));
}

#else

// Exponents are shifted as integers; a subnormal half is made whole by one subtraction of 2^-14.
HWY_INLINE Vector load_state(const Half* row) {
  const Words d;
  const auto half = hn::PromoteTo(d, hn::Load(Shorts(), row));
  const auto magnitude = hn::ShiftLeft<13>(hn::And(half, hn::Set(d, 0x7fffu)));
  const auto moved = hn::Add(magnitude, hn::Set(d, 112u << 23));
  const auto beyond = hn::Add(magnitude, hn::Set(d, 224u << 23));  // infinity and NaN
  const auto tiny =
      hn::Sub(hn::BitCast(Floats(), hn::Add(magnitude, hn::Set(d, 113u << 23))), hn::Set(Floats(), 0x1p-14f));
  auto bits = hn::IfThenElse(hn::Gt(magnitude, hn::Set(d, 0x0f7fffffu)), beyond, moved);
  bits = hn::IfThenElse(hn::Lt(magnitude, hn::Set(d, 1u << 23)), hn::BitCast(d, tiny), bits);
  const auto sign = hn::ShiftLeft<16>(hn::And(half, hn::Set(d, 0x8000u)));
  return hn::BitCast(Floats(), hn::Or(bits, sign));
}

// A subnormal half is what the sum with 1/2 leaves in a float's last ten bits, rounded by that sum.
HWY_INLINE void store_state(Vector value, Half* row) {
  const Words d;
  const auto bits = hn::BitCast(d, value);
  const auto magnitude = hn::And(bits, hn::Set(d, 0x7fffffffu));
  const auto odd = hn::And(hn::ShiftRight<13>(magnitude), hn::Set(d, 1u));
  const auto rounded = hn::Add(magnitude, hn::Add(odd, hn::Set(d, 0xfffu)));
  auto half = hn::ShiftRight<13>(hn::Sub(rounded, hn::Set(d, 112u << 23)));
  const Vector sum = hn::Add(hn::BitCast(Floats(), magnitude), hn::Set(Floats(), 0.5f));
  const auto tiny = hn::Sub(hn::BitCast(d, sum), hn::Set(d, 126u << 23));
  half = hn::IfThenElse(hn::Lt(magnitude, hn::Set(d, 113u << 23)), tiny, half);
  half = hn::IfThenElse(hn::Gt(magnitude, hn::Set(d, (143u << 23) - 1)), hn::Set(d, 0x7c00u), half);
  half = hn::IfThenElse(hn::Gt(magnitude, hn::Set(d, 255u << 23)), hn::Set(d, 0x7e00u), half);
  const auto sign = hn::And(hn::ShiftRight<16>(bits), hn::Set(d, 0x8000u));
  const hn::RebindToSigned<Words> di;
  hn::Store(hn::DemoteTo(Shorts(), hn::BitCast(di, hn::Or(half, sign))), Shorts(), row);
}

#endif

// `count` of them as floats, in `out`.
HWY_INLINE const float* floats_of(const Half* row, size_t count, float* out) {
  for (size_t j = 0; j < count; j += kLanes) hn::Store(load_state(row + j), Floats(), out + j);
  return out;
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

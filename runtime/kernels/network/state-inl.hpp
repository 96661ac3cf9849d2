// state-inl.hpp  Rows of a layer's state. Layers are written for any kind of number that has these three; the
// runtime's are floats (baker/research/precision/half_state-inl.hpp has halves).
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

HWY_INLINE Vector load_state(const float* row) { return hn::Load(Floats(), row); }
HWY_INLINE void store_state(Vector value, float* row) { hn::Store(value, Floats(), row); }

// `count` state numbers as floats: where they lie, or in `out`.
HWY_INLINE const float* floats_of(const float* row, size_t, float*) { return row; }

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// activation-inl.hpp  tanh and sigmoid of arrays (tanh-inl.hpp).
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

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

template <class Curve>
void sigmoid(const float* x, size_t count, float* out) {
  map_floats(x, count, out, [](Vector v) HWY_ATTR { return value_of(sigmoid_of<Curve>(v)); });
}

template <class Curve>
void tanh(const float* x, size_t count, float* out) {
  map_floats(x, count, out, [](Vector v) HWY_ATTR { return value_of(tanh_of<Curve>(v)); });
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

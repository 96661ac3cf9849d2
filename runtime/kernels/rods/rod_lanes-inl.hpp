// rod_lanes-inl.hpp  Quaternions of many strands at once, and a group's records.
//
// As all of rod_*-inl.hpp, included by files that are compiled once a target (rod_kernels.cpp, and
// baker/research/rods/kernels.cpp): no include guard.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {
template <class V>
struct Four {  // a quaternion
  V x, y, z, w;
};

template <class V>
HWY_INLINE Three<V> vector_part(const Four<V>& q) {
  return {q.x, q.y, q.z};
}
template <class V>
HWY_INLINE Four<V> scaled(V s, const Four<V>& q) {
  return {hn::Mul(s, q.x), hn::Mul(s, q.y), hn::Mul(s, q.z), hn::Mul(s, q.w)};
}
template <class V>
HWY_INLINE Four<V> choose(hn::Mask<hn::DFromV<V>> mask, const Four<V>& yes, const Four<V>& no) {
  const Three<V> part = choose(mask, vector_part(yes), vector_part(no));
  return {part.x, part.y, part.z, hn::IfThenElse(mask, yes.w, no.w)};
}

template <class V>
HWY_INLINE Four<V> product(const Four<V>& a, const Four<V>& b) {
  const Three<V> u = vector_part(a), v = vector_part(b);
  const Three<V> part = scaled_sum(a.w, v, scaled_sum(b.w, u, cross(u, v)));
  return {part.x, part.y, part.z, hn::Sub(hn::Mul(a.w, b.w), dot(u, v))};
}
// conj(a) b, on the half of the double cover where w is not negative.
template <class V>
HWY_INLINE Four<V> relative(const Four<V>& a, const Four<V>& b) {
  const hn::DFromV<V> d;
  const Three<V> u = vector_part(a), v = vector_part(b);
  const Three<V> part = less_scaled(b.w, u, scaled_sum(a.w, v, cross(v, u)));
  const V w = hn::MulAdd(a.w, b.w, dot(u, v));
  const V sign = hn::And(w, hn::Set(d, -0.0f));
  return {hn::Xor(part.x, sign), hn::Xor(part.y, sign), hn::Xor(part.z, sign), hn::Abs(w)};
}
template <class V>
HWY_INLINE Four<V> normalised(const Four<V>& q) {
  const hn::DFromV<V> d;
  const V square = hn::MulAdd(q.w, q.w, dot(vector_part(q), vector_part(q)));
  return scaled(hn::Div(hn::Set(d, 1), hn::Sqrt(square)), q);
}
// q turned about its own axes: by the Cayley map, 2 atan(|turn| / 2).
template <class V>
HWY_INLINE Four<V> turned(const Four<V>& q, const Three<V>& turn) {
  const hn::DFromV<V> d;
  const Three<V> half = scaled(hn::Set(d, 0.5f), turn);
  return normalised(product(q, Four<V>{half.x, half.y, half.z, hn::Set(d, 1)}));
}

// Of a segment: place, then rotation; of a joint: force, then moment.
template <class V>
struct Six {
  Three<V> f, t;
};

// Own axes in the world.
template <class V>
struct SegmentAxes {
  Three<V> x, y, z;
};
template <class V>
HWY_INLINE SegmentAxes<V> axes_of(const Four<V>& q) {
  const V two = hn::Set(hn::DFromV<V>(), 2), one = hn::Set(hn::DFromV<V>(), 1);
  const V x2 = hn::Mul(two, q.x), y2 = hn::Mul(two, q.y), z2 = hn::Mul(two, q.z);
  const V xx = hn::Mul(x2, q.x), xy = hn::Mul(x2, q.y), xz = hn::Mul(x2, q.z), xw = hn::Mul(x2, q.w);
  const V yy = hn::Mul(y2, q.y), yz = hn::Mul(y2, q.z), yw = hn::Mul(y2, q.w);
  const V zz = hn::Mul(z2, q.z), zw = hn::Mul(z2, q.w);
  return {{hn::Sub(one, hn::Add(yy, zz)), hn::Add(xy, zw), hn::Sub(xz, yw)},
          {hn::Sub(xy, zw), hn::Sub(one, hn::Add(xx, zz)), hn::Add(yz, xw)},
          {hn::Add(xz, yw), hn::Sub(yz, xw), hn::Sub(one, hn::Add(xx, yy))}};
}

// The records of one vector of lanes.
template <class D, size_t kWidth>
struct Group {
  using V = hn::Vec<D>;
  float* records;
  float* scratch;
  float* work;
  float* lanes;
  float* contacts;         // null where the group touches nothing
  const uint8_t* touched;  // of all lanes

  HWY_INLINE float* at(size_t segment, size_t field) const {
    if (field < kRodKeptFields) return records + (segment * kRodKeptFields + field) * kWidth;
    return field < kRodScratchFields
               ? scratch + (segment * kRodScratchRows + (field - kRodKeptFields)) * kWidth
               : work + (segment * kRodWorkRows + (field - kRodScratchFields)) * kWidth;
  }
  HWY_INLINE V get(size_t segment, size_t field) const { return hn::Load(D(), at(segment, field)); }
  HWY_INLINE void set(size_t segment, size_t field, V value) const {
    hn::Store(value, D(), at(segment, field));
  }
  HWY_INLINE Three<V> get3(size_t segment, size_t field) const {
    return {get(segment, field), get(segment, field + 1), get(segment, field + 2)};
  }
  HWY_INLINE void set3(size_t segment, size_t field, const Three<V>& v) const {
    set(segment, field, v.x);
    set(segment, field + 1, v.y);
    set(segment, field + 2, v.z);
  }
  HWY_INLINE Four<V> get4(size_t segment, size_t field) const {
    return {get(segment, field), get(segment, field + 1), get(segment, field + 2), get(segment, field + 3)};
  }
  HWY_INLINE void set4(size_t segment, size_t field, const Four<V>& q) const {
    set3(segment, field, vector_part(q));
    set(segment, field + 3, q.w);
  }
  HWY_INLINE bool touches(size_t segment) const { return contacts && touched[segment] != 0; }
  HWY_INLINE V contact(size_t segment, size_t row) const {
    return hn::Load(D(), contacts + (segment * kRodContactRows + row) * kWidth);
  }
  HWY_INLINE void set_contact(size_t segment, size_t row, V value) const {
    hn::Store(value, D(), contacts + (segment * kRodContactRows + row) * kWidth);
  }
  HWY_INLINE V lane(size_t field) const { return hn::Load(D(), lanes + field * kWidth); }
  HWY_INLINE void set_lane(size_t field, V value) const { hn::Store(value, D(), lanes + field * kWidth); }
  HWY_INLINE auto free(size_t segment) const { return hn::Gt(get(segment, kRodFree), hn::Zero(D())); }
};

// Never wider than the group.
template <size_t kWidth>
using LanesOf = hn::CappedTag<float, kWidth>;

template <class D, size_t kWidth>
HWY_INLINE Group<D, kWidth> lanes_from(const RodJob& job, size_t first) {
  return {job.records + first,
          job.scratch + first,
          job.work + first,
          job.lanes + first,
          job.contacts ? job.contacts + first : nullptr,
          job.touched};
}

// body(group) for each vector of the group's lanes.
template <size_t kWidth, class Body>
HWY_INLINE void for_lanes(const RodJob& job, const Body& body) {
  using D = LanesOf<kWidth>;
  for (size_t i = 0; i < kWidth; i += hn::MaxLanes(D())) body(lanes_from<D, kWidth>(job, i));
}

// Whether any of these strands is to be iterated.
template <class D, size_t kWidth>
HWY_INLINE bool any_active(const RodJob& job, size_t first) {
  const auto active = lanes_from<D, kWidth>(job, first).lane(kLaneActive);
  return !hn::AllFalse(D(), hn::Gt(active, hn::Zero(D())));
}

// The same for those vectors alone in which a strand is to be iterated, sixteen lanes as eight where the
// others rest: of strands that touch something few go on, and a processor may take half the time for half the
// lanes.
template <size_t kWidth, class Body>
HWY_INLINE void for_active_lanes(const RodJob& job, const Body& body) {
  using D = LanesOf<kWidth>;
  if constexpr (hn::MaxLanes(D()) == 16) {
    using Half = hn::CappedTag<float, 8>;
    const bool low = any_active<Half, kWidth>(job, 0), high = any_active<Half, kWidth>(job, 8);
    if (low && high) return body(lanes_from<D, kWidth>(job, 0));
    if (low || high) body(lanes_from<Half, kWidth>(job, low ? 0 : 8));
  } else {
    for (size_t i = 0; i < kWidth; i += hn::MaxLanes(D())) {
      if (any_active<D, kWidth>(job, i)) body(lanes_from<D, kWidth>(job, i));
    }
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// rod_look-inl.hpp  What a contact's point of a segment moved in the step, with the bits of
// ContactForces::look.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// rods/turn.hpp
template <class V>
HWY_INLINE SegmentAxes<V> plain_axes(const Four<V>& q) {
  const hn::DFromV<V> d;
  const V two = hn::Set(d, 2), one = hn::Set(d, 1);
  const V x2 = hn::Mul(two, q.x), y2 = hn::Mul(two, q.y), z2 = hn::Mul(two, q.z);
  const V xx = hn::Mul(x2, q.x), yy = hn::Mul(y2, q.y), zz = hn::Mul(z2, q.z);
  const V xy = hn::Mul(x2, q.y), xz = hn::Mul(x2, q.z), yz = hn::Mul(y2, q.z);
  const V xw = hn::Mul(x2, q.w), yw = hn::Mul(y2, q.w), zw = hn::Mul(z2, q.w);
  return {{hn::Sub(hn::Sub(one, yy), zz), hn::Add(xy, zw), hn::Sub(xz, yw)},
          {hn::Sub(xy, zw), hn::Sub(hn::Sub(one, xx), zz), hn::Add(yz, xw)},
          {hn::Add(xz, yw), hn::Sub(yz, xw), hn::Sub(hn::Sub(one, xx), yy)}};
}
template <class V>
HWY_INLINE V plain_product_part(V aw, V b, V bw, V a, V a1, V b2, V a2, V b1) {
  return hn::Sub(hn::Add(hn::Add(hn::Mul(aw, b), hn::Mul(bw, a)), hn::Mul(a1, b2)), hn::Mul(a2, b1));
}
template <class V>
HWY_INLINE Four<V> plain_product(const Four<V>& a, const Four<V>& b) {
  const V w =
      hn::Sub(hn::Sub(hn::Sub(hn::Mul(a.w, b.w), hn::Mul(a.x, b.x)), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
  return {plain_product_part(a.w, b.x, b.w, a.x, a.y, b.z, a.z, b.y),
          plain_product_part(a.w, b.y, b.w, a.y, a.z, b.x, a.x, b.z),
          plain_product_part(a.w, b.z, b.w, a.z, a.x, b.y, a.y, b.x), w};
}

// ContactForces::surface_move
template <class V>
HWY_INLINE Three<V> surface_move_of(const Four<V>& before, const Four<V>& now, const SegmentAxes<V>& own,
                                    V radius, const Three<V>& normal, const Three<V>& move) {
  const hn::DFromV<V> d;
  const Four<V> back = {hn::Neg(before.x), hn::Neg(before.y), hn::Neg(before.z), before.w};
  const Four<V> by = plain_product(back, now);
  const V side = hn::IfThenElse(hn::Lt(by.w, hn::Zero(d)), hn::Set(d, -2), hn::Set(d, 2));
  const Three<V> turned_by =
      scaled(side, plain_sum(by.x, own.x, plain_sum(by.y, own.y, scaled(by.z, own.z))));
  return plain_sum(radius, plain_cross(turned_by, normal), move);
}

// ContactForces::look of a point of a segment that moved so, against an obstacle's: how far it opened since
// the step's start, and its slip.
template <class V>
struct LookOf {
  V opened;
  Three<V> slip;
};
template <class V>
struct LookedAt {
  Four<V> before, now;
  Three<V> moved, axis, normal, obstacle;
  V along, radius;
};
template <class V>
HWY_INLINE LookOf<V> look_of(const LookedAt<V>& c) {
  const SegmentAxes<V> own = plain_axes(c.now);
  const Three<V> move = plain_sum(c.along, own.z - c.axis, c.moved);
  const Three<V> surface = surface_move_of(c.before, c.now, own, c.radius, c.normal, move);
  return {plain_dot(c.normal, move - c.obstacle), plain_across(surface - c.obstacle, c.normal)};
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

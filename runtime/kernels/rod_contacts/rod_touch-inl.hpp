// rod_touch-inl.hpp  Where segments of a group first touch a sphere or capsule on their way through a step.
//
// first_touch and add_at of rods/, a strand a lane, operation by operation in their order: a contact has the
// same bits wherever it is found. No operation is fused.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Into 0 to 1, as std::clamp.
template <class V>
HWY_INLINE V shared(V x) {
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1);
  return hn::IfThenElse(hn::Lt(x, zero), zero, hn::IfThenElse(hn::Lt(one, x), one, x));
}

template <class V>
struct LineOf {
  Three<V> from, to;
};
template <class V>
struct SweepOf {
  LineOf<V> start, end;
};
template <class V>
HWY_INLINE Three<V> on_line(const LineOf<V>& line, V share) {
  return plain_between(line.from, line.to, share);
}
template <class V>
HWY_INLINE LineOf<V> line_at(const SweepOf<V>& sweep, V time) {
  return {plain_between(sweep.start.from, sweep.end.from, time),
          plain_between(sweep.start.to, sweep.end.to, time)};
}

// The share of a line nearest to a point.
template <class V>
HWY_INLINE V share_nearest(const LineOf<V>& line, const Three<V>& point) {
  const hn::DFromV<V> d;
  const Three<V> along = line.to - line.from;
  const V square = plain_dot(along, along);
  const V share = shared(hn::Div(plain_dot(point - line.from, along), square));
  return hn::IfThenElseZero(hn::Gt(square, hn::Set(d, kRodNoLength2)), share);
}

template <class V>
struct SharesOf {
  V a, b;
};
template <class V>
HWY_INLINE SharesOf<V> nearest_shares(const LineOf<V>& a, const LineOf<V>& b) {
  const hn::DFromV<V> d;
  const V none = hn::Set(d, kRodNoLength2);
  const Three<V> u = a.to - a.from, v = b.to - b.from, r = a.from - b.from;
  const V uu = plain_dot(u, u), vv = plain_dot(v, v), uv = plain_dot(u, v);
  const V ur = plain_dot(u, r), vr = plain_dot(v, r), sine = hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv));
  const auto crossing = hn::Gt(sine, hn::Mul(hn::Mul(hn::Set(d, kRodParallel), uu), vv));
  V s = shared(hn::Div(hn::Sub(hn::Mul(uv, vr), hn::Mul(ur, vv)), sine));
  if (!hn::AllTrue(d, crossing)) {
    const V beside = hn::Mul(hn::Set(d, 0.5), hn::Add(share_nearest(a, b.from), share_nearest(a, b.to)));
    s = hn::IfThenElse(crossing, s, beside);
  }
  const V t = shared(hn::Div(hn::Add(hn::Mul(uv, s), vr), vv));
  const auto a_is_point = hn::Not(hn::Gt(uu, none)), b_is_point = hn::Not(hn::Gt(vv, none));
  const V of_b = hn::IfThenElse(a_is_point, share_nearest(b, a.from), hn::IfThenZeroElse(b_is_point, t));
  return {share_nearest(a, on_line(b, of_b)), of_b};
}

template <class V>
struct TouchOf {
  V time;
  SharesOf<V> at;
  Three<V> apart;
  V distance, gap;
};

template <bool kPoint, class V>
HWY_INLINE TouchOf<V> touch_at(const SweepOf<V>& a, const SweepOf<V>& b, V time, V radii) {
  const LineOf<V> now_a = line_at(a, time), now_b = line_at(b, time);
  const hn::DFromV<V> d;
  const SharesOf<V> at =
      kPoint ? SharesOf<V>{share_nearest(now_a, now_b.from), hn::Zero(d)} : nearest_shares(now_a, now_b);
  const Three<V> apart = on_line(now_a, at.a) - on_line(now_b, at.b);
  const V distance = plain_length(apart);
  return {time, at, apart, distance, hn::Sub(distance, radii)};
}

template <class V, class M>
HWY_INLINE TouchOf<V> choose_touch(M mask, const TouchOf<V>& yes, const TouchOf<V>& no) {
  const auto one = [&](V a, V b) HWY_ATTR { return hn::IfThenElse(mask, a, b); };
  return {one(yes.time, no.time),
          {one(yes.at.a, no.at.a), one(yes.at.b, no.at.b)},
          choose(mask, yes.apart, no.apart),
          one(yes.distance, no.distance),
          one(yes.gap, no.gap)};
}

// No two points of the sweeps near each other faster, in metres a step. The root of the largest square is the
// largest root, to the bit.
template <class V>
HWY_INLINE V closing_of(const SweepOf<V>& a, const SweepOf<V>& b) {
  const Three<V> a0 = a.end.from - a.start.from, a1 = a.end.to - a.start.to;
  const Three<V> b0 = b.end.from - b.start.from, b1 = b.end.to - b.start.to;
  const auto square = [](const Three<V>& v) HWY_ATTR { return plain_dot(v, v); };
  return hn::Sqrt(
      hn::Max(hn::Max(square(a0 - b0), square(a0 - b1)), hn::Max(square(a1 - b0), square(a1 - b1))));
}

// Lanes of `axes_meet` came so near at some moment that apart has no direction.
template <bool kPoint, class V, class M>
HWY_INLINE TouchOf<V> touch_first(const SweepOf<V>& a, const SweepOf<V>& b, V radii, M wanted, M* axes_meet) {
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1), speed = closing_of(a, b);
  const V enough = hn::Mul(hn::Set(d, kRodTouching), radii),
          meeting = hn::Mul(hn::Set(d, kRodMeeting), radii);
  TouchOf<V> best = touch_at<kPoint>(a, b, zero, radii);
  V time = zero, gap = best.gap;
  *axes_meet = hn::Not(hn::Gt(best.distance, meeting));
  for (int k = 1; k < kRodMoments; ++k) {
    const auto goes_on = hn::And(wanted, hn::And(hn::Gt(gap, enough), hn::Lt(time, one)));
    if (hn::AllFalse(d, goes_on)) break;
    const auto ends = hn::Ge(gap, hn::Mul(speed, hn::Sub(one, time)));
    const V next = hn::IfThenElse(ends, one, hn::Add(time, hn::Div(gap, speed)));
    const TouchOf<V> now = touch_at<kPoint>(a, b, hn::IfThenElse(hn::Lt(one, next), one, next), radii);
    *axes_meet = hn::Or(*axes_meet, hn::And(goes_on, hn::Not(hn::Gt(now.distance, meeting))));
    best = choose_touch(hn::And(goes_on, hn::Lt(now.gap, best.gap)), now, best);
    time = hn::IfThenElse(goes_on, now.time, time), gap = hn::IfThenElse(goes_on, now.gap, gap);
  }
  return best;
}

// Some lanes of a segment's, from the group's record.
template <class D, size_t kWidth>
struct TouchGroup {
  using V = hn::Vec<D>;
  const RodReachJob& job;
  size_t segment, first;

  HWY_INLINE V floats(const float* from) const {
    return hn::PromoteTo(D(), hn::Load(hn::Rebind<float, D>(), from));
  }
  HWY_INLINE V get(size_t field) const {
    return floats(field < kRodKeptFields
                      ? job.records + (segment * kRodKeptFields + field) * kWidth + first
                      : job.scratch + (segment * kRodScratchRows + field - kRodKeptFields) * kWidth + first);
  }
  HWY_INLINE Three<V> get3(size_t field) const { return {get(field), get(field + 1), get(field + 2)}; }
  HWY_INLINE Four<V> get4(size_t field) const {
    return {get(field), get(field + 1), get(field + 2), get(field + 3)};
  }
  HWY_INLINE V length() const { return floats(job.length_m + first); }
  // Its own z, at an orientation.
  HWY_INLINE Three<V> axis(size_t field) const {
    const auto [x, y, z, w] = get4(field);
    const V two = hn::Set(D(), 2), one = hn::Set(D(), 1);
    return {hn::Mul(two, hn::Add(hn::Mul(x, z), hn::Mul(y, w))),
            hn::Mul(two, hn::Sub(hn::Mul(y, z), hn::Mul(x, w))),
            hn::Sub(one, hn::Mul(two, hn::Add(hn::Mul(x, x), hn::Mul(y, y))))};
  }
  HWY_INLINE V place(size_t k) const {
    const V at = hn::Add(get(kRodPlace + k), get(kRodPlaceLow + k));
    return hn::Add(hn::Load(D(), job.origin_m + k * kWidth + first), hn::Mul(at, length()));
  }
  HWY_INLINE LineOf<V> line(const Three<V>& middle, const Three<V>& axis) const {
    const V half = hn::Mul(get(kRodHalfLength), length());
    return {plain_sum(hn::Neg(half), axis, middle), plain_sum(half, axis, middle)};
  }
  HWY_INLINE SweepOf<V> sweep() const {
    const Three<V> middle = {place(0), place(1), place(2)};
    return {line(middle, axis(kRodTurn)),
            line(middle + scaled(length(), get3(kRodFreeMove)), axis(kRodFreeTurn))};
  }
};

template <class D>
HWY_INLINE Three<hn::Vec<D>> set3(D d, const double (&v)[3]) {
  return {hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2])};
}

// Side by side at the time of touching, or deep and end on: contacts that are not the touch alone.
template <bool kPoint, class V>
HWY_INLINE auto other_kinds(const SweepOf<V>& a, const SweepOf<V>& b, const TouchOf<V>& touch,
                            const Three<V>& normal, V radius) {
  const hn::DFromV<V> d;
  const Three<V> z = a.start.to - a.start.from;
  const auto deep =
      hn::And(hn::Eq(touch.time, hn::Zero(d)), hn::Lt(touch.gap, hn::Mul(hn::Set(d, -kRodDeep), radius)));
  const auto end_on = hn::Gt(hn::Abs(plain_dot(normal, z)), hn::Mul(hn::Set(d, kRodEndOn), plain_length(z)));
  const auto odd = hn::And(deep, end_on);
  if (kPoint) return odd;
  const LineOf<V> now_a = line_at(a, touch.time), now_b = line_at(b, touch.time);
  const Three<V> u = now_a.to - now_a.from, v = now_b.to - now_b.from, across_both = plain_cross(u, v);
  const V uu = plain_dot(u, u), vv = plain_dot(v, v), sine = plain_dot(across_both, across_both);
  return hn::Or(odd, hn::Lt(sine, hn::Mul(hn::Mul(hn::Set(d, kRodSideBySide), uu), vv)));
}

template <class V>
HWY_INLINE Three<V> surface_move_at(const RodRound& round, const Three<V>& surface) {
  const hn::DFromV<V> d;
  const Three<V> arm = surface - set3(d, round.middle_m);
  return scaled(hn::Set(d, round.dt_s),
                set3(d, round.linear_m_s) + plain_cross(set3(d, round.angular_rad_s), arm));
}

template <bool kPoint, size_t kWidth, class D>
HWY_INLINE void touch_lanes(const RodReachJob& job, const RodRound& round, uint32_t segment, size_t first,
                            uint32_t wanted_bits, RodTouches* out) {
  using V = hn::Vec<D>;
  const D d;
  const TouchGroup<D, kWidth> g{job, segment, first};
  const SweepOf<V> a = g.sweep();
  const SweepOf<V> b = {{set3(d, round.start_m[0]), set3(d, round.start_m[1])},
                        {set3(d, round.end_m[0]), set3(d, round.end_m[1])}};
  const V radius = g.floats(job.radii_m + segment * kWidth + first),
          other_radius = hn::Set(d, round.radius_m);
  const uint8_t asked[8] = {static_cast<uint8_t>(wanted_bits >> first)};
  const auto wanted = hn::LoadMaskBits(d, asked);
  auto meets = wanted;
  const TouchOf<V> touch = touch_first<kPoint>(a, b, hn::Add(radius, other_radius), wanted, &meets);
  const Three<V> way_a = on_line(a.end, touch.at.a) - on_line(a.start, touch.at.a);
  const Three<V> point_b = on_line(b.start, touch.at.b), end_b = on_line(b.end, touch.at.b);
  const V way = plain_length(way_a - (end_b - point_b));
  const V near = hn::Add(hn::Mul(hn::Set(d, kRodNearRadii), radius), hn::Mul(hn::Set(d, kRodNearWay), way));
  const auto touches = hn::And(wanted, hn::Or(meets, hn::Lt(touch.gap, near)));
  if (hn::AllFalse(d, touches)) return;
  const Three<V> normal = scaled(hn::Div(hn::Set(d, 1), touch.distance), touch.apart);
  const auto other = hn::And(touches, hn::Or(meets, other_kinds<kPoint>(a, b, touch, normal, radius)));
  out->other |= lane_bits(d, other, first);
  out->touch |= lane_bits(d, hn::AndNot(other, touches), first);

  const auto put = [&](size_t row, V value) HWY_ATTR { hn::Store(value, d, out->rows[row] + first); };
  const auto put3 = [&](size_t row, const Three<V>& v)
                        HWY_ATTR { put(row, v.x), put(row + 1, v.y), put(row + 2, v.z); };
  const Three<V> z = a.start.to - a.start.from;
  const V length = plain_length(z), along = hn::Mul(hn::Sub(touch.at.a, hn::Set(d, 0.5)), length);
  const Three<V> axis = scaled(hn::Div(hn::Set(d, 1), length), z);
  put(kTouchAlong, along);
  put3(kTouchAxis, axis);
  put3(kTouchNormal, normal);
  const Three<V> surface = plain_sum(other_radius, normal, end_b), axis_move = end_b - point_b;
  const Three<V> slides = surface_move_at(round, surface);
  const Three<V> move = plain_sum(plain_dot(normal, axis_move), normal, plain_across(slides, normal));
  put3(kTouchMove, move);
  const V start = plain_dot(on_line(a.start, touch.at.a) - point_b, normal);
  const V gap = hn::Sub(hn::Sub(start, radius), other_radius);
  put(kTouchGap, gap);
  put(kTouchDepth, hn::IfThenZeroElse(hn::Gt(touch.time, hn::Zero(d)), touch.gap));
  const LookOf<V> look = look_of<V>({g.get4(kRodTurn), g.get4(kRodNow), scaled(g.length(), g.get3(kRodMove)),
                                     axis, normal, move, along, hn::Neg(radius)});
  put(kTouchOpen, hn::Add(gap, look.opened));
  put3(kTouchSlip, look.slip);
}

template <bool kPoint, size_t kWidth>
HWY_INLINE void touch_all(const RodReachJob& job, const RodRound& round, uint32_t segment, uint32_t lanes,
                          RodTouches* out) {
  using D = hn::CappedTag<double, kWidth>;
  constexpr size_t kStep = hn::MaxLanes(D());
  for (size_t i = 0; i < kWidth; i += kStep) {
    if (lanes >> i & ((1u << kStep) - 1)) touch_lanes<kPoint, kWidth, D>(job, round, segment, i, lanes, out);
  }
}

template <size_t kWidth>
void rod_touch(const RodReachJob& job, const RodRound& round, uint32_t segment, uint32_t lanes,
               RodTouches* out) {
  out->touch = out->other = 0;
  bool point = true;
  for (size_t k = 0; k < 3; ++k) {
    point = point && round.start_m[0][k] == round.start_m[1][k] && round.end_m[0][k] == round.end_m[1][k];
  }
  point ? touch_all<true, kWidth>(job, round, segment, lanes, out)
        : touch_all<false, kWidth>(job, round, segment, lanes, out);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// rod_reach-inl.hpp  Which segments of a group may touch an obstacle, and which may enter its core.
//
//   reach     1.25 r and 1.25 of the way that an end goes freely, or the way to the first iterate if longer
//   sphere    least |p + s a|, -1 <= s <= 1, p its middle from the sphere's, a half its axis
//   capsule   |d| - |d . a| / |d|, d from the nearest point of its axis to p, as distance is convex along a
//   plane     n . p - |n . a|
// Each less what float may have rounded off. What leaves float's range counts as near.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Over the ways and radii that a contact is kept for, with what float leaves of a way.
inline constexpr float kReachWays = 1.25001f, kReachRadii = 1.25001f;
// Over the coordinates that a distance was computed from: some ten roundings, several times.
inline constexpr float kReachRounding = 2e-6f;
// Of the sum of radii, a little more than what counts as a core (rods/contacts/find/find_contacts.cpp).
inline constexpr float kReachCore = 0.55f;

template <class D, size_t kWidth>
struct ReachGroup {
  using V = hn::Vec<D>;
  const RodReachJob& job;
  size_t first;  // lane

  HWY_INLINE V get(size_t segment, size_t field) const {
    const float* row = field < kRodKeptFields
                           ? job.records + (segment * kRodKeptFields + field) * kWidth
                           : job.scratch + (segment * kRodScratchRows + field - kRodKeptFields) * kWidth;
    return hn::Load(D(), row + first);
  }
  HWY_INLINE Three<V> get3(size_t segment, size_t field) const {
    return {get(segment, field), get(segment, field + 1), get(segment, field + 2)};
  }
  HWY_INLINE Four<V> get4(size_t segment, size_t field) const {
    return {get(segment, field), get(segment, field + 1), get(segment, field + 2), get(segment, field + 3)};
  }
  HWY_INLINE float* row(size_t segment, size_t row) const {
    return job.reaches + (segment * kReachRows + row) * kWidth + first;
  }
  HWY_INLINE V reach(size_t segment, size_t r) const { return hn::Load(D(), row(segment, r)); }
  HWY_INLINE void set(size_t segment, size_t r, V value) const { hn::Store(value, D(), row(segment, r)); }
  HWY_INLINE V box(size_t side) const { return hn::Load(D(), job.boxes + side * kWidth + first); }
  HWY_INLINE void set_box(size_t side, V value) const {
    hn::Store(value, D(), job.boxes + side * kWidth + first);
  }
  // Metres as they are for each strand, in its units.
  template <class Metres>
  HWY_INLINE Three<V> in_units(const Metres& metres) const {
    HWY_ALIGN float out[3][kWidth];
    for (size_t k = 0; k < kWidth; ++k) {
      const double per_length = 1 / static_cast<double>(job.length_m[k]);
      for (size_t i = 0; i < 3; ++i) out[i][k] = static_cast<float>(metres(i, k) * per_length);
    }
    return {hn::Load(D(), out[0] + first), hn::Load(D(), out[1] + first), hn::Load(D(), out[2] + first)};
  }
  HWY_INLINE Three<V> way(const double* from, const double* to) const {
    return in_units([&](size_t i, size_t) HWY_ATTR { return to[i] - from[i]; });
  }
  HWY_INLINE Three<V> place(const double* at) const {
    return in_units([&](size_t i, size_t k) HWY_ATTR { return at[i] - job.origin_m[i * kWidth + k]; });
  }
  HWY_INLINE V size(double metres) const {
    return hn::Div(hn::Set(D(), static_cast<float>(metres)), hn::Load(D(), job.length_m + first));
  }
};

template <class V>
HWY_INLINE V size1(const Three<V>& v) {
  return hn::Add(hn::Abs(v.x), hn::Add(hn::Abs(v.y), hn::Abs(v.z)));
}

// How far a segment's end goes at most to a move and a turn: 2 |q - p| bounds how its axis turns.
template <class G>
HWY_INLINE typename G::V reach_way(const G& g, size_t i, uint32_t move_to, uint32_t turn_to) {
  using V = typename G::V;
  const Three<V> move = g.get3(i, move_to);
  const Four<V> p = g.get4(i, kRodTurn), q = g.get4(i, turn_to);
  const Three<V> by = vector_part(q) - vector_part(p);
  const V w = hn::Sub(q.w, p.w), turn = hn::Sqrt(hn::MulAdd(w, w, dot(by, by)));
  const V length = hn::Add(g.get(i, kRodHalfLength), g.get(i, kRodHalfLength));
  return hn::MulAdd(length, turn, hn::Sqrt(dot(move, move)));
}

// All of it where squares may leave float's range.
template <class G>
HWY_INLINE typename G::V reach_margin(const G& g, size_t i, typename G::V obstacle) {
  const hn::DFromV<typename G::V> d;
  const auto margin = hn::Mul(hn::Set(d, kReachRounding), hn::Add(g.reach(i, kReachFar), obstacle));
  return hn::IfThenElse(hn::Lt(margin, hn::Set(d, 1e12f)), margin, hn::Inf(d));
}

// Returns how far from its middle a segment may touch something.
template <class G>
HWY_INLINE typename G::V reach_segment(const G& g, size_t i, size_t width) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V half = g.get(i, kRodHalfLength);
  const Three<V> place = g.get3(i, kRodPlace), first = g.get3(i, kRodMove);
  const Three<V> axis = scaled(half, axes_of(g.get4(i, kRodTurn)).z);
  const V free = hn::Mul(hn::Set(d, kReachWays), reach_way(g, i, kRodFreeMove, kRodFreeTurn));
  const V way = hn::Max(free, hn::Sqrt(dot(first, first)));
  const V radius =
      hn::Div(hn::Load(d, g.job.radii_m + i * width + g.first), hn::Load(d, g.job.length_m + g.first));
  const V touch = hn::MulAdd(hn::Set(d, kReachRadii), radius, way);
  g.set(i, kReachAxis, axis.x), g.set(i, kReachAxis + 1, axis.y), g.set(i, kReachAxis + 2, axis.z);
  g.set(i, kReachTouch, touch);
  g.set(i, kReachRadius, radius);
  g.set(i, kReachFar, hn::Add(size1(place), hn::Add(half, hn::Set(d, 1))));
  g.set(i, kReachClear, hn::Inf(d));
  return hn::Add(hn::Add(half, touch), reach_margin(g, i, hn::Zero(d)));
}

template <size_t kWidth, class Body>
HWY_INLINE void for_reach_lanes(const RodReachJob& job, const Body& body) {
  using D = LanesOf<kWidth>;
  for (size_t i = 0; i < kWidth; i += hn::MaxLanes(D())) body(ReachGroup<D, kWidth>{job, i});
}

template <size_t kWidth>
void rod_reach(const RodReachJob& job) {
  for_reach_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    const LanesOf<kWidth> d;
    const auto far = hn::Inf(d), near = hn::Neg(far);
    Three<decltype(hn::Zero(d))> low = {far, far, far}, high = {near, near, near};
    for (size_t i = 0; i < job.segments; ++i) {
      const auto by = reach_segment(g, i, kWidth);
      const auto at = g.get3(i, kRodPlace);
      low = {hn::Min(low.x, hn::Sub(at.x, by)), hn::Min(low.y, hn::Sub(at.y, by)),
             hn::Min(low.z, hn::Sub(at.z, by))};
      high = {hn::Max(high.x, hn::Add(at.x, by)), hn::Max(high.y, hn::Add(at.y, by)),
              hn::Max(high.z, hn::Add(at.z, by))};
    }
    g.set_box(kBoxLow, low.x), g.set_box(kBoxLow + 1, low.y), g.set_box(kBoxLow + 2, low.z);
    g.set_box(kBoxHigh, high.x), g.set_box(kBoxHigh + 1, high.y), g.set_box(kBoxHigh + 2, high.z);
    g.set_box(kBoxClear, far);
  });
}

// Lanes from `first` on, of a mask of one vector of them.
template <class D, class M>
HWY_INLINE uint32_t lane_bits(D d, M mask, size_t first) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return (uint32_t{bytes[0]} | uint32_t{bytes[1]} << 8) << first;
}

// From strands' boxes to what lies between two corners, along one of the axes.
template <class G, class V>
HWY_INLINE V box_gap(const G& g, const Three<V>& from, const Three<V>& along) {
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d);
  const auto apart = [&](V at, V by, size_t axis) HWY_ATTR {
    const V low = hn::Add(at, hn::Min(by, zero)), high = hn::Add(at, hn::Max(by, zero));
    return hn::Max(hn::Sub(g.box(kBoxLow + axis), high), hn::Sub(low, g.box(kBoxHigh + axis)));
  };
  const V flat = hn::Max(apart(from.x, along.x, 0), apart(from.y, along.y, 1));
  return hn::Max(flat, apart(from.z, along.z, 2));
}

// From a segment's axis to a point, at least.
template <class V>
HWY_INLINE V reach_to_point(const Three<V>& apart, const Three<V>& axis) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), back = hn::Neg(one);
  const V along = hn::Neg(hn::Div(dot(apart, axis), dot(axis, axis)));
  const V above = hn::IfThenElse(hn::Gt(along, back), along, back);
  const Three<V> away = scaled_sum(hn::IfThenElse(hn::Lt(above, one), above, one), axis, apart);
  return hn::Sqrt(dot(away, away));
}

// And to an axis `u`. An error of d turns by `margin` over its length.
template <class V>
HWY_INLINE V reach_to_axis(const Three<V>& apart, const Three<V>& axis, V half, const Three<V>& u,
                           V per_square, V margin) {
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1);
  const V along = hn::Mul(per_square, dot(apart, u)),
          above = hn::IfThenElse(hn::Gt(along, zero), along, zero);
  const Three<V> across = less_scaled(hn::IfThenElse(hn::Lt(above, one), above, one), u, apart);
  const V away = hn::Sqrt(dot(across, across));
  const V error = hn::Mul(hn::Add(margin, margin), half);
  const V slope = hn::Add(hn::Abs(dot(across, axis)), error);
  const V nearer = hn::IfThenElse(hn::Lt(slope, hn::Mul(half, away)), hn::Div(slope, away), half);
  return hn::Sub(away, nearer);
}

// Also keeps what is left of the way before a core.
template <bool kPoint, size_t kWidth, class G>
HWY_INLINE bool near_lanes(const G& g, const RodRound& round, uint16_t* lanes) {
  using V = typename G::V;
  const LanesOf<kWidth> d;
  const Three<V> from = g.place(round.start_m[0]), u = g.way(round.start_m[0], round.start_m[1]);
  const V radius = g.size(round.radius_m), way = g.size(round.way_m);
  const V reach = hn::MulAdd(hn::Set(d, kReachWays), way, radius);
  const V size = hn::Add(hn::Add(size1(from), size1(u)), reach);
  const V wide = hn::MulAdd(hn::Set(d, kReachRounding), size, reach);
  const V gap = box_gap(g, from, u);
  if (hn::AllTrue(d, hn::Gt(gap, wide))) {
    g.set_box(kBoxClear, hn::Min(g.box(kBoxClear), hn::Sub(gap, wide)));
    return false;
  }
  const V uu = dot(u, u), least = hn::Set(d, 1e-12f);
  const V per_square = hn::IfThenElseZero(hn::Gt(uu, least), hn::Div(hn::Set(d, 1), hn::Max(uu, least)));
  bool any = false;
  for (size_t i = 0; i < g.job.segments; ++i) {
    const Three<V> axis = {g.reach(i, kReachAxis), g.reach(i, kReachAxis + 1), g.reach(i, kReachAxis + 2)};
    const Three<V> apart = g.get3(i, kRodPlace) - from;
    const V margin = reach_margin(g, i, size);
    const V distance = kPoint ? reach_to_point(apart, axis)
                              : reach_to_axis(apart, axis, g.get(i, kRodHalfLength), u, per_square, margin);
    const V least_distance = hn::Sub(distance, margin);
    const V core = hn::MulAdd(hn::Set(d, kReachCore), hn::Add(g.reach(i, kReachRadius), radius), way);
    const V left = hn::Sub(least_distance, core), clear = g.reach(i, kReachClear);
    g.set(i, kReachClear, hn::IfThenElse(hn::Ge(left, clear), clear, left));
    const auto near = hn::Not(hn::Ge(least_distance, hn::Add(g.reach(i, kReachTouch), reach)));
    const auto free = hn::Gt(g.get(i, kRodFree), hn::Zero(d));
    const uint32_t bits = lane_bits(d, hn::And(near, free), g.first);
    lanes[i] = static_cast<uint16_t>(lanes[i] | bits);
    any |= bits != 0;
  }
  return any;
}

// Lanes of a group's padding are never told.
HWY_INLINE bool keep_strands(const RodReachJob& job, bool any, uint16_t* lanes) {
  const uint32_t there = (1u << job.strands) - 1;
  if (!any) return false;
  uint32_t all = 0;
  for (size_t i = 0; i < job.segments; ++i) {
    lanes[i] = static_cast<uint16_t>(lanes[i] & there);
    all |= lanes[i];
  }
  return all != 0;
}

HWY_INLINE void clear_lanes(const RodReachJob& job, uint16_t* lanes) {
  for (size_t i = 0; i < job.segments; ++i) lanes[i] = 0;
}

template <size_t kWidth>
bool rod_near_round(const RodReachJob& job, const RodRound& round, uint16_t* lanes) {
  clear_lanes(job, lanes);
  bool point = true, any = false;
  for (size_t k = 0; k < 3; ++k) point = point && round.start_m[0][k] == round.start_m[1][k];
  for_reach_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    any |= point ? near_lanes<true, kWidth>(g, round, lanes) : near_lanes<false, kWidth>(g, round, lanes);
  });
  return keep_strands(job, any, lanes);
}

template <size_t kWidth>
bool rod_near_flat(const RodReachJob& job, const RodFlat& flat, uint16_t* lanes) {
  clear_lanes(job, lanes);
  bool any = false;
  for_reach_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    using V = decltype(g.size(0));
    const LanesOf<kWidth> d;
    const auto set = [&](double x) HWY_ATTR { return hn::Set(d, static_cast<float>(x)); };
    const Three<V> n = {set(flat.normal[0]), set(flat.normal[1]), set(flat.normal[2])};
    const Three<V> point = g.place(flat.point_m);
    // The height of the strand's origin, before it is rounded.
    HWY_ALIGN float heights[kWidth];
    for (size_t k = 0; k < kWidth; ++k) {
      double height = 0;
      for (size_t i = 0; i < 3; ++i)
        height += flat.normal[i] * (job.origin_m[i * kWidth + k] - flat.point_m[i]);
      heights[k] = static_cast<float>(height / static_cast<double>(job.length_m[k]));
    }
    const V start = hn::Load(d, heights + g.first), way = g.size(flat.way_m), turn = set(flat.turn_rad);
    for (size_t i = 0; i < job.segments; ++i) {
      const Three<V> at = g.get3(i, kRodPlace), arm = at - point;
      const Three<V> axis = {g.reach(i, kReachAxis), g.reach(i, kReachAxis + 1), g.reach(i, kReachAxis + 2)};
      const V touch = g.reach(i, kReachTouch), margin = reach_margin(g, i, hn::Abs(start));
      const V height = hn::Sub(hn::Sub(hn::Add(dot(n, at), start), hn::Abs(dot(n, axis))), margin);
      const V far = hn::Add(hn::Sqrt(dot(arm, arm)), hn::Add(g.get(i, kRodHalfLength), touch));
      const V moved = hn::Mul(set(2 * kReachWays), hn::MulAdd(turn, far, way));
      const auto near = hn::Not(hn::Ge(height, hn::Add(touch, moved)));
      const uint32_t bits = lane_bits(d, hn::And(near, hn::Gt(g.get(i, kRodFree), hn::Zero(d))), g.first);
      lanes[i] = static_cast<uint16_t>(lanes[i] | bits);
      any |= bits != 0;
    }
  });
  return keep_strands(job, any, lanes);
}

template <size_t kWidth>
bool rod_enter(const RodReachJob& job, uint16_t* lanes) {
  clear_lanes(job, lanes);
  bool any = false;
  for_reach_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    const LanesOf<kWidth> d;
    const auto all_clear = g.box(kBoxClear);
    for (size_t i = 0; i < job.segments; ++i) {
      const auto way = hn::Mul(hn::Set(d, 1.00001f), reach_way(g, i, kRodMove, kRodNow));
      // The box goes that far beyond the axis; its own share of a core is not in it.
      const auto own_core = hn::Mul(hn::Set(d, kReachCore), g.reach(i, kReachRadius));
      const auto far_clear = hn::Sub(hn::Add(all_clear, g.reach(i, kReachTouch)), own_core);
      const auto clear = hn::And(hn::Lt(way, g.reach(i, kReachClear)), hn::Lt(way, far_clear));
      const auto enters = hn::Not(clear);
      const uint32_t bits = lane_bits(d, hn::And(enters, hn::Gt(g.get(i, kRodFree), hn::Zero(d))), g.first);
      lanes[i] = static_cast<uint16_t>(lanes[i] | bits);
      any |= bits != 0;
    }
  });
  return keep_strands(job, any, lanes);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

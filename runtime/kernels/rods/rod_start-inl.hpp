// rod_start-inl.hpp  Where a step's iteration starts from, made of what earlier steps ended with.
//
// With r a step's result (acceleration, angular acceleration, force, moment: four triples a segment) and d_t
// = r_t - r_{t-1}, a triple is continued by
//   r_{t+1} = r_t + a d_t + b (d_t - d_{t-1})
// a and b being what, of the whole strand, would have served the step before best: least of |d_t - a d_{t-1}
// - b (d_{t-1} - d_{t-2})|^2. a = b = 1 continues a parabola, a = b = 0 repeats the last step; what swings
// against the time step gets a below 0. Cost: some 12 multiply-adds a number.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// A vector of lanes' rows of the last results but one, two and three.
template <class D, size_t kWidth>
struct StartHistory {
  float* ages[kRodStartAges];  // of segment 0

  HWY_INLINE float* at(size_t age, size_t i, size_t part) const {
    return ages[age] + (i * kRodStartAges * kRodStartNumbers + part) * kWidth;
  }
  HWY_INLINE Three<hn::Vec<D>> get3(size_t age, size_t i, size_t part) const {
    const D d;
    return {hn::Load(d, at(age, i, part)), hn::Load(d, at(age, i, part + 1)),
            hn::Load(d, at(age, i, part + 2))};
  }
  HWY_INLINE void keep3(size_t age, size_t i, size_t part, const Three<hn::Vec<D>>& v) const {
    hn::Store(v.x, D(), at(age, i, part));
    hn::Store(v.y, D(), at(age, i, part + 1));
    hn::Store(v.z, D(), at(age, i, part + 2));
  }
};

template <size_t kWidth, class G>
HWY_INLINE auto start_history(const G& g, const RodJob& job, const RodStartJob& start) {
  float* first = start.history + (g.records - job.records);
  const auto of = [&](uint32_t age) {
    return first + (start.newest + kRodStartAges - age) % kRodStartAges * kRodStartNumbers * kWidth;
  };
  return StartHistory<LanesOf<kWidth>, kWidth>{{of(0), of(1), of(2)}};
}

// Added to the diagonal of the fit, of itself: what noise makes of a motion that two numbers describe well.
inline constexpr float kStartDamping = 1e-2f;
inline constexpr float kLargestStartShare = 1.5f;  // of a and b

template <class V>
struct Shares {
  V a, b;
};

// Products of a triple's d_{t-1}, d_{t-1} - d_{t-2} and d_t, summed over the strand.
template <class V>
struct StartFit {
  V xx, xy, yy, xz, yz;
};

template <class G, class H>
HWY_INLINE void add_to_fit(const G& g, const H& history, size_t i, size_t part,
                           StartFit<typename G::V>* fit) {
  using V = typename G::V;
  const Three<V> r1 = history.get3(0, i, part), r2 = history.get3(1, i, part);
  const Three<V> z = g.get3(i, kRodStartPush + part) - r1, x = r1 - r2;
  const Three<V> y = x - (r2 - history.get3(2, i, part));
  fit->xx = hn::Add(fit->xx, dot(x, x));
  fit->xy = hn::Add(fit->xy, dot(x, y));
  fit->yy = hn::Add(fit->yy, dot(y, y));
  fit->xz = hn::Add(fit->xz, dot(x, z));
  fit->yz = hn::Add(fit->yz, dot(y, z));
}

template <class V>
HWY_INLINE Shares<V> shares_of(const StartFit<V>& fit) {
  const hn::DFromV<V> d;
  const V grown = hn::Set(d, 1 + kStartDamping), least = hn::Set(d, 1e-30f);
  const V most = hn::Set(d, kLargestStartShare), low = hn::Neg(most);
  const V xx = hn::MulAdd(fit.xx, grown, least), yy = hn::MulAdd(fit.yy, grown, least);
  const V per = hn::Div(hn::Set(d, 1), hn::Max(hn::NegMulAdd(fit.xy, fit.xy, hn::Mul(xx, yy)), least));
  const V a = hn::Mul(per, hn::NegMulAdd(fit.xy, fit.yz, hn::Mul(yy, fit.xz)));
  const V b = hn::Mul(per, hn::NegMulAdd(fit.xy, fit.xz, hn::Mul(xx, fit.yz)));
  return {hn::Max(low, hn::Min(a, most)), hn::Max(low, hn::Min(b, most))};
}

template <class G, class H, class M>
HWY_INLINE void continue_triple(const G& g, const H& history, size_t i, size_t part,
                                const Shares<typename G::V>& shares, M known) {
  using V = typename G::V;
  const Three<V> r = g.get3(i, kRodStartPush + part), r1 = history.get3(0, i, part);
  const V both = hn::Add(shares.a, shares.b);
  const Three<V> next = scaled_sum(both, r - r1, less_scaled(shares.b, r1 - history.get3(1, i, part), r));
  g.set3(i, kRodStartPush + part, choose(known, next, r));
  history.keep3(kRodStartAges - 1, i, part, r);
}

template <size_t kWidth, class G>
HWY_INLINE void continue_results(const G& g, const RodJob& job, const RodStartJob& start) {
  using V = typename G::V;
  const LanesOf<kWidth> d;
  const auto history = start_history<kWidth>(g, job, start);
  const auto known = hn::Ge(g.lane(kLaneKnownSteps), hn::Set(d, float{kRodStartKnown}));
  const V zero = hn::Zero(d);
  const StartFit<V> none = {zero, zero, zero, zero, zero};
  StartFit<V> fits[kRodStartTriples] = {none, none, none, none};
  for (size_t i = 0; i < job.segments; ++i) {
    SINEW_UNROLL
    for (size_t t = 0; t < kRodStartTriples; ++t) add_to_fit(g, history, i, 3 * t, &fits[t]);
  }
  const Shares<V> shares[kRodStartTriples] = {shares_of(fits[0]), shares_of(fits[1]), shares_of(fits[2]),
                                              shares_of(fits[3])};
  for (size_t i = 0; i < job.segments; ++i) {
    SINEW_UNROLL
    for (size_t t = 0; t < kRodStartTriples; ++t) continue_triple(g, history, i, 3 * t, shares[t], known);
  }
}

// The rows of one of a group's arrays [segments][numbers][width], for a vector of its lanes.
template <class D, size_t kWidth>
struct LaneRows {
  float* first;
  size_t numbers;

  HWY_INLINE float* at(size_t i, size_t k) const { return first + (i * numbers + k) * kWidth; }
  HWY_INLINE hn::Vec<D> get(size_t i, size_t k) const { return hn::Load(D(), at(i, k)); }
  HWY_INLINE void set(size_t i, size_t k, hn::Vec<D> v) const { hn::Store(v, D(), at(i, k)); }
  HWY_INLINE Three<hn::Vec<D>> get3(size_t i, size_t k) const {
    return {get(i, k), get(i, k + 1), get(i, k + 2)};
  }
  HWY_INLINE void set3(size_t i, size_t k, const Three<hn::Vec<D>>& v) const {
    set(i, k, v.x);
    set(i, k + 1, v.y);
    set(i, k + 2, v.z);
  }
};

// Triples in the world's axes: accelerations and forces.
HWY_INLINE constexpr bool in_world(size_t part) { return part == 0 || part == 6; }

template <class V>
HWY_INLINE Three<V> to_own(const SegmentAxes<V>& axes, const Three<V>& v) {
  return {dot(axes.x, v), dot(axes.y, v), dot(axes.z, v)};
}
template <class V>
HWY_INLINE Three<V> to_world(const SegmentAxes<V>& axes, const Three<V>& v) {
  return scaled_sum(v.x, axes.x, scaled_sum(v.y, axes.y, scaled(v.z, axes.z)));
}

// By how much the last continuation missed, unscaled; returns the sums of squares.
template <class G, class Rows>
HWY_INLINE void tell_misses(const G& g, const RodJob& job, const Rows& continued, const Rows& inputs,
                            typename G::V (&sums)[kRodStartTriples]) {
  using V = typename G::V;
  for (size_t i = 0; i < job.segments; ++i) {
    const SegmentAxes<V> axes = axes_of(g.get4(i, kRodTurn));
    for (size_t t = 0; t < kRodStartTriples; ++t) {
      Three<V> miss = g.get3(i, kRodStartPush + 3 * t) - continued.get3(i, 3 * t);
      if (in_world(3 * t)) miss = to_own(axes, miss);
      sums[t] = hn::Add(sums[t], dot(miss, miss));
      inputs.set3(i, 3 * t, miss);
    }
  }
}

// Inputs over their scales, and the share of what was missed in what the joints carry.
template <class G, class Rows>
HWY_INLINE void scale_inputs(const G& g, const RodJob& job, const Rows& inputs,
                             const typename G::V (&scales)[kRodStartTriples]) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), least = hn::Set(d, 1e-20f),
          per = hn::Set(d, 1.0f / static_cast<float>(job.segments));
  V carried = hn::Zero(d), by[kRodStartTriples];
  for (size_t i = 0; i < job.segments; ++i) {
    const Three<V> f = g.get3(i, kRodStartForce);
    carried = hn::MulAdd(per, dot(f, f), carried);
  }
  const V share = hn::Div(scales[2], hn::Add(hn::Add(scales[2], hn::Sqrt(carried)), least));
  for (size_t t = 0; t < kRodStartTriples; ++t) by[t] = hn::Div(one, hn::Max(scales[t], least));
  for (size_t i = 0; i < job.segments; ++i) {
    for (size_t t = 0; t < kRodStartTriples; ++t) inputs.set3(i, 3 * t, scaled(by[t], inputs.get3(i, 3 * t)));
    inputs.set(i, kRodStartInputs - 1, share);
  }
}

template <size_t kWidth, class G>
HWY_INLINE auto lane_rows(const G& g, const RodJob& job, float* rows, size_t numbers) {
  return LaneRows<LanesOf<kWidth>, kWidth>{rows + (g.records - job.records), numbers};
}

template <size_t kWidth, class G>
HWY_INLINE void tell_inputs(const G& g, const RodJob& job, const RodStartJob& start) {
  using V = typename G::V;
  const LanesOf<kWidth> d;
  const auto inputs = lane_rows<kWidth>(g, job, start.inputs, kRodStartInputs);
  V sums[kRodStartTriples] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  tell_misses(g, job, lane_rows<kWidth>(g, job, start.continued, kRodStartNumbers), inputs, sums);
  const V per = hn::Set(d, 1.0f / static_cast<float>(job.segments));
  for (size_t t = 0; t < kRodStartTriples; ++t) {
    sums[t] = hn::Sqrt(hn::Mul(per, sums[t]));
    hn::Store(sums[t], d, start.scales + t * kWidth + (g.records - job.records));
  }
  scale_inputs(g, job, inputs, sums);
}

template <size_t kWidth>
void rod_continue(const RodJob& job, const RodStartJob& start) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    if (start.inputs) tell_inputs<kWidth>(g, job, start);
    continue_results<kWidth>(g, job, start);
    if (!start.inputs) return;
    const auto kept = lane_rows<kWidth>(g, job, start.continued, kRodStartNumbers);
    for (size_t i = 0; i < job.segments; ++i) {
      for (size_t k = 0; k < kRodStartNumbers; ++k) kept.set(i, k, g.get(i, kRodStartPush + k));
    }
  });
}

// Adds a correction of the triple at `part`, in own axes and over its scale; one that is not finite is none.
template <size_t kWidth, class G, class M>
HWY_INLINE void correct(const G& g, const RodJob& job, const RodStartJob& start, size_t i, size_t part,
                        const Three<typename G::V>& correction, const SegmentAxes<typename G::V>& axes,
                        M meant) {
  using V = typename G::V;
  const V scale = hn::IfThenElseZero(
      meant, hn::Load(LanesOf<kWidth>(), start.scales + part / 3 * kWidth + (g.records - job.records)));
  const Three<V> world = in_world(part) ? to_world(axes, correction) : correction;
  const Three<V> was = g.get3(i, kRodStartPush + part);
  const Three<V> sum = scaled_sum(scale, world, was);
  const auto finite = hn::And(hn::And(hn::IsFinite(sum.x), hn::IsFinite(sum.y)), hn::IsFinite(sum.z));
  g.set3(i, kRodStartPush + part, choose(hn::And(meant, finite), sum, was));
}

template <class G>
HWY_INLINE auto inputs_mean_something(const G& g) {
  return hn::Ge(g.lane(kLaneKnownSteps), hn::Set(hn::DFromV<typename G::V>(), kRodStartKnown + 1.0f));
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

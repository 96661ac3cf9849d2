// rod_step-inl.hpp  The beginning and the end of a rod's step: free motion, first iterate, new state.
//
//   free motion     d* = h v + h^2 (g + f/m),  q* = q exp(h Omega) exp(h spin z)
//     of a symmetric top, exact: Omega = (w_x, w_y, w_z Ia/I), spin = (1 - Ia/I) w_z; what the body feels of
//     w turns by -h spin about z.
//   damping         (1 + t/h) C - (t/h) C_0 + alpha lambda / h^2 = 0 with C_0 at the step's start, divided by
//     1 + t/h: a smaller compliance and a moved rest, so that what stands still feels nothing of it.
//     h^2 of forces, compliance and damping is h times RodJob::force_s, so that a fraction of a step leads to
//     where the step does (rods/solver/step_between.cpp).
//   new state       v = d/h,  w = w* + 2 Im(conj(q*) q)/h
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// sin(x)/x and cos(x) of x^2 below (pi/2)^2; errors below 1e-6.
template <class V>
HWY_INLINE V sine_over(V s) {
  const hn::DFromV<V> d;
  V sum = hn::Set(d, -2.5052108e-8f);
  sum = hn::MulAdd(sum, s, hn::Set(d, 2.7557319e-6f));
  sum = hn::MulAdd(sum, s, hn::Set(d, -1.9841270e-4f));
  sum = hn::MulAdd(sum, s, hn::Set(d, 8.3333333e-3f));
  sum = hn::MulAdd(sum, s, hn::Set(d, -1.6666667e-1f));
  return hn::MulAdd(sum, s, hn::Set(d, 1));
}
template <class V>
HWY_INLINE V cosine(V s) {
  const hn::DFromV<V> d;
  V sum = hn::Set(d, 2.0876757e-9f);
  sum = hn::MulAdd(sum, s, hn::Set(d, -2.7557319e-7f));
  sum = hn::MulAdd(sum, s, hn::Set(d, 2.4801587e-5f));
  sum = hn::MulAdd(sum, s, hn::Set(d, -1.3888889e-3f));
  sum = hn::MulAdd(sum, s, hn::Set(d, 4.1666667e-2f));
  sum = hn::MulAdd(sum, s, hn::Set(d, -0.5f));
  return hn::MulAdd(sum, s, hn::Set(d, 1));
}

// The rotation by `turn`, below pi.
template <class V>
HWY_INLINE Four<V> rotation_by(const Three<V>& turn) {
  const hn::DFromV<V> d;
  const V square = hn::Mul(hn::Set(d, 0.25f), dot(turn, turn));
  const Three<V> part = scaled(hn::Mul(hn::Set(d, 0.5f), sine_over(square)), turn);
  return {part.x, part.y, part.z, cosine(square)};
}

template <class G>
HWY_INLINE void predict_move(const G& g, size_t i, typename G::V h, typename G::V force) {
  using V = typename G::V;
  const V one = hn::Set(hn::DFromV<V>(), 1);
  const V slowed = hn::Div(h, hn::MulAdd(force, g.get(i, kRodDrag), one));
  const Three<V> gravity = {g.lane(kLaneGravity), g.lane(kLaneGravity + 1), g.lane(kLaneGravity + 2)};
  const Three<V> push = scaled_sum(g.get(i, kRodInverseMass), g.get3(i, kRodForce), gravity);
  const Three<V> speed = scaled_sum(force, push, g.get3(i, kRodVelocity));
  g.set3(i, kRodFreeMove, choose(g.free(i), scaled(slowed, speed), g.get3(i, kRodTarget)));
}

template <class G>
HWY_INLINE void predict_turn(const G& g, size_t i, typename G::V h, typename G::V force) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1);
  const V slowed = hn::Div(one, hn::MulAdd(force, g.get(i, kRodDrag), one));
  Three<V> w = scaled(slowed, g.get3(i, kRodSpin));
  // Faster than kRodLargestSpin_rad a step nothing can be followed.
  const V turn = hn::Mul(h, hn::Sqrt(dot(w, w))), most = hn::Set(d, kRodLargestSpin_rad);
  w = scaled(hn::Div(most, hn::Max(most, turn)), w);
  const V flat = hn::Div(g.get(i, kRodAxialInertia), g.get(i, kRodInertia));
  const Three<V> wander = {hn::Mul(h, w.x), hn::Mul(h, w.y), hn::Mul(hn::Mul(h, flat), w.z)};
  const Three<V> spin = {zero, zero, hn::Mul(hn::Mul(h, hn::Sub(one, flat)), w.z)};
  const Four<V> by_spin = rotation_by(spin);
  const Four<V> q = product(product(g.get4(i, kRodTurn), rotation_by(wander)), by_spin);
  // cos and sin of the whole spin from those of its half.
  const V c = hn::NegMulAdd(hn::Add(by_spin.z, by_spin.z), by_spin.z, one);
  const V s = hn::Mul(hn::Add(by_spin.z, by_spin.z), by_spin.w);
  const Three<V> felt = {hn::MulAdd(s, w.y, hn::Mul(c, w.x)), hn::NegMulAdd(s, w.x, hn::Mul(c, w.y)), w.z};
  g.set4(i, kRodFreeTurn, choose(g.free(i), normalised(q), g.get4(i, kRodTargetTurn)));
  g.set3(i, kRodFreeSpin, felt);
}

template <class G>
HWY_INLINE void predict_joint(const G& g, size_t i, size_t parent, typename G::V h, typename G::V force) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V two = hn::Set(d, 2);
  const Four<V> q_a = g.get4(parent, kRodTurn), q_b = g.get4(i, kRodTurn);
  const Three<V> z_a = axes_of(q_a).z, z_b = axes_of(q_b).z;
  const V t = g.get(i, kRodDamping), share = hn::Div(t, hn::Add(h, t));
  const V per_step = hn::Div(hn::Set(d, 1), hn::Mul(force, hn::Add(h, t)));
  const V stretch = g.get(i, kRodStretchCompliance);
  // A joint that does not give is not damped either: its error is to vanish at once.
  const V stretch_share = hn::IfThenElseZero(hn::Gt(stretch, hn::Zero(d)), share);
  const Three<V> gap = (g.get3(parent, kRodPlace) - g.get3(i, kRodPlace)) +
                       (g.get3(parent, kRodPlaceLow) - g.get3(i, kRodPlaceLow));
  const Three<V> stretched =
      scaled_sum(g.get(i, kRodParentArm), z_a, scaled_sum(g.get(i, kRodArm), z_b, gap));
  g.set3(i, kRodGap, less_scaled(stretch_share, stretched, gap));
  const Three<V> rest = g.get3(i, kRodRest), bent = scaled(two, vector_part(relative(q_a, q_b)));
  g.set3(i, kRodStepRest, scaled_sum(share, bent - rest, rest));
  g.set(i, kRodStepCompliance,
        hn::Div(stretch, hn::Mul(force, hn::IfThenElse(hn::Gt(stretch, hn::Zero(d)), hn::Add(h, t), h))));
  g.set(i, kRodStepCompliance + 1, hn::Mul(per_step, g.get(i, kRodBendCompliance)));
  g.set(i, kRodStepCompliance + 2, hn::Mul(per_step, g.get(i, kRodTwistCompliance)));
}

// h^2 of the joints' acceleration on top of free motion; all of it nothing where the pose is given.
template <class G>
HWY_INLINE void start_iterate(const G& g, size_t i, typename G::V square) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), free_square = hn::Mul(square, g.get(i, kRodFree));
  Three<V> turn = scaled(free_square, g.get3(i, kRodStartTwist));
  const V size = hn::Sqrt(dot(turn, turn));
  turn = scaled(hn::Div(one, hn::Max(one, size)), turn);
  g.set3(i, kRodMove, scaled_sum(free_square, g.get3(i, kRodStartPush), g.get3(i, kRodFreeMove)));
  g.set4(i, kRodNow, turned(g.get4(i, kRodFreeTurn), turn));
  for (uint32_t k = 0; k < 6; ++k) {
    g.set(i, kRodForceNow + k, hn::Mul(square, g.get(i, kRodStartForce + k)));
  }
}

// What a start's accelerations are worth in a step.
template <class D>
HWY_INLINE hn::Vec<D> start_square(D d, const RodJob& job) {
  return hn::Set(d, job.start_from_zero ? 0.0f : job.dt_s * job.force_s);
}

template <size_t kWidth>
void rod_predict(const RodJob& job) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    const LanesOf<kWidth> d;
    const auto h = hn::Set(d, job.dt_s), force = hn::Set(d, job.force_s);
    const auto square = start_square(d, job);
    for (size_t i = 0; i < job.segments; ++i) {
      predict_move(g, i, h, force);
      predict_turn(g, i, h, force);
      if (i > 0) predict_joint(g, i, job.parents[i], h, force);
      start_iterate(g, i, square);
    }
    g.set_lane(kLaneIterations, hn::Zero(d));
    g.set_lane(kLaneBroken, hn::Zero(d));
  });
}

// x + d as two floats again (Knuth's exact sum).
template <class V>
HWY_INLINE void add_exactly(V move, V* high, V* low) {
  const V sum = hn::Add(*high, move);
  const V back = hn::Sub(sum, *high);
  const V lost = hn::Add(hn::Sub(*high, hn::Sub(sum, back)), hn::Sub(move, back));
  const V rest = hn::Add(*low, lost);
  *high = hn::Add(sum, rest);
  *low = hn::Sub(rest, hn::Sub(*high, sum));
}

template <class G>
HWY_INLINE void finish_move(const G& g, size_t i, typename G::V per_step, typename G::V per_square) {
  using V = typename G::V;
  const Three<V> move = g.get3(i, kRodMove);
  g.set3(i, kRodVelocity, scaled(per_step, move));
  g.set3(i, kRodStartPush, scaled(per_square, move - g.get3(i, kRodFreeMove)));
  Three<V> place = g.get3(i, kRodPlace), low = g.get3(i, kRodPlaceLow);
  add_exactly(move.x, &place.x, &low.x);
  add_exactly(move.y, &place.y, &low.y);
  add_exactly(move.z, &place.z, &low.z);
  g.set3(i, kRodPlace, place);
  g.set3(i, kRodPlaceLow, low);
  g.set3(i, kRodTarget, scaled(hn::Zero(hn::DFromV<V>()), g.get3(i, kRodTarget)));
}

template <class G>
HWY_INLINE void finish_turn(const G& g, size_t i, typename G::V per_step, typename G::V per_square) {
  using V = typename G::V;
  const V two = hn::Set(hn::DFromV<V>(), 2);
  const Four<V> now = g.get4(i, kRodNow);
  const Three<V> corrected = scaled(two, vector_part(relative(g.get4(i, kRodFreeTurn), now)));
  const Three<V> whole = scaled(two, vector_part(relative(g.get4(i, kRodTurn), now)));
  const Three<V> spin = scaled_sum(per_step, corrected, g.get3(i, kRodFreeSpin));
  g.set3(i, kRodSpin, choose(g.free(i), spin, scaled(per_step, whole)));
  g.set3(i, kRodStartTwist, scaled(per_square, corrected));
  g.set4(i, kRodTurn, now);
  g.set4(i, kRodTargetTurn, now);
}

// Of a joint whose segments have come to the step's end, squared; of one that may stretch none.
template <class G>
HWY_INLINE typename G::V finished_gap_square(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const Three<V> z_a = axes_of(g.get4(parent, kRodTurn)).z, z_b = axes_of(g.get4(i, kRodTurn)).z;
  const Three<V> apart = (g.get3(parent, kRodPlace) - g.get3(i, kRodPlace)) +
                         (g.get3(parent, kRodPlaceLow) - g.get3(i, kRodPlaceLow));
  const Three<V> gap = scaled_sum(g.get(i, kRodParentArm), z_a, scaled_sum(g.get(i, kRodArm), z_b, apart));
  const auto stretches = hn::Gt(g.get(i, kRodStretchCompliance), hn::Zero(hn::DFromV<V>()));
  return hn::IfThenZeroElse(stretches, dot(gap, gap));
}

// Zero, or NaN where anything that a next step reads is not finite.
template <class G>
HWY_INLINE typename G::V finish_segment(const G& g, size_t i, typename G::V h) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V per_step = hn::Div(hn::Set(d, 1), h), per_square = hn::Mul(per_step, per_step);
  finish_move(g, i, per_step, per_square);
  finish_turn(g, i, per_step, per_square);
  V sum = hn::Zero(d);
  for (uint32_t k = 0; k < 6; ++k) {
    const V force = hn::Mul(per_square, g.get(i, kRodForceNow + k));
    g.set(i, kRodStartForce + k, force);
    sum = hn::MulAdd(hn::Zero(d), force, sum);
  }
  for (uint32_t k = kRodPlace; k < kRodStartForce; ++k) sum = hn::MulAdd(hn::Zero(d), g.get(i, k), sum);
  return sum;
}

template <size_t kWidth>
void rod_finish(const RodJob& job) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    const LanesOf<kWidth> d;
    const auto h = hn::Set(d, job.dt_s);
    auto sum = hn::Zero(d), gap_square = hn::Zero(d);
    for (size_t i = 0; i < job.segments; ++i) {
      sum = hn::Add(sum, finish_segment(g, i, h));
      if (i > 0) gap_square = hn::Max(gap_square, finished_gap_square(g, i, job.parents[i]));
    }
    g.set_lane(kLaneBroken, hn::IfThenElse(hn::Eq(sum, sum), hn::Zero(d), hn::Set(d, 1)));
    g.set_lane(kLaneGapSquare, gap_square);
  });
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

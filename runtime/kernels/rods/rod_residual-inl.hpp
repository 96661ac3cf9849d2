// rod_residual-inl.hpp  How far an iterate is from the step's equations, whatever solver and start led to it.
//
// The largest, of a strand, of |C_stretch + alpha f| in its mean segment's lengths, of |C_bend + alpha t| in
// radians, and of the momentum residual over the strand's largest force or moment, a mean segment's weight at
// least (rod_linearise-inl.hpp has the equations). Costs what setting one iteration up costs.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

template <class V>
HWY_INLINE V largest_square(V largest, const Three<V>& v) {
  return hn::Max(largest, dot(v, v));
}

template <class G>
HWY_INLINE typename G::V strand_residual(const G& g, const RodJob& job) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), square = hn::Set(d, job.dt_s * job.dt_s);
  const Three<V> gravity = {g.lane(kLaneGravity), g.lane(kLaneGravity + 1), g.lane(kLaneGravity + 2)};
  // Squares. Without gravity, a millionth of a segment's length in the step.
  V force = largest_square(hn::Set(d, 1e-12f), scaled(square, gravity)), momentum = zero, miss = zero;
  for (size_t i = 0; i < job.segments; ++i) {
    const auto free = g.free(i);
    momentum = hn::Max(momentum, hn::IfThenElseZero(free, largest_square(zero, g.get3(i, kRodImpulse))));
    momentum = hn::Max(momentum, hn::IfThenElseZero(free, largest_square(zero, g.get3(i, kRodImpulse + 3))));
    if (i == 0) continue;
    const auto works = hn::Eq(g.get(i, kRodTied), zero);
    miss = hn::Max(miss, hn::IfThenElseZero(works, largest_square(zero, g.get3(i, kRodMiss))));
    miss = hn::Max(miss, hn::IfThenElseZero(works, largest_square(zero, g.get3(i, kRodMiss + 3))));
    force = largest_square(largest_square(force, g.get3(i, kRodForceNow)), g.get3(i, kRodForceNow + 3));
  }
  return hn::Sqrt(hn::Max(miss, hn::Div(momentum, force)));
}

// Leaves the iterate as it is.
template <size_t kWidth>
void rod_residual(const RodJob& job) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    linearise(g, job);
    add_contact_forces(g, job);
    g.set_lane(kLaneResidual, strand_residual(g, job));
  });
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

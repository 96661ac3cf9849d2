// rod_linearise-inl.hpp  The rod's equations about the iterate, and what an iteration changes.
//
// Unknown are each segment's displacement d and rotation, and each joint's force f and moment t (times h^2):
//   m (d - d*) - J^T (f, t) = 0,  I 2 Im(conj(q*) q) - J^T (f, t) = 0       momentum
//   C(d, q) + alpha (f, t) = 0                                           constraints
//   C_stretch = gap + d_a - d_b + l_a z_a + l_b z_b                      Kugelstadt & Schoemer 2016, Eq. 3
//   C_bend    = 2 Im(conj(q_a) q_b) - rest                               the same, Eq. 8, times the length
// the implicit Euler step in its mixed form: whatever the iteration starts from, where it ends does not
// depend on it. One iteration solves
//   M delta x - J^T delta(f, t) = -g,   J delta x + alpha delta(f, t) = -(C + alpha (f, t))
// with g the momentum residual and M mass and inertia. What the second derivative of the constraints adds,
// the geometric stiffness, would be indefinite blocks between segments. Taken of it is
//   of tension  sum max(0, l f.z) over the segment's two ends, added to the inertia about x and y: without it
//               soft rods do not converge;
//   of moments  -t.(phi_a x phi_b)/2, the torque that turns along with both segments, put into J: in the
//               matrix C_bend changes as w (phi_b - phi_a) + (p + alpha t/4) x (phi_a + phi_b), and the
//               moment by t x (phi_a + phi_b)/4 more than solved for. What is thereby left out is negative.
//               Without it rods that bend stiffly and twist softly do not converge: alpha t/4 of twist is
//               then many times p.
// M stays diagonal, and J as full as it was.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// A v and A^T v with A = w + [p]x of the relative orientation: how C_bend changes with b's and, negative,
// with a's rotation.
template <class V>
HWY_INLINE Three<V> bend_by_child(const Four<V>& p, const Three<V>& v) {
  return scaled_sum(p.w, v, cross(vector_part(p), v));
}
template <class V>
HWY_INLINE Three<V> bend_by_parent(const Four<V>& p, const Three<V>& v) {
  return scaled_sum(p.w, v, cross(v, vector_part(p)));
}

// How C_bend changes in the matrix: w + C by the child's rotation, C - w by the parent's, with the rows of C
// those of [bent]x but for the last, of twist, which has its own x and y.
template <class V>
struct BendRows {
  V w;
  Three<V> bent;
  V twist_x, twist_y;
};
template <class G>
HWY_INLINE BendRows<typename G::V> bend_rows(const G& g, size_t i) {
  using V = typename G::V;
  const V quarter = hn::Set(hn::DFromV<V>(), 0.25f);
  const Four<V> p = g.get4(i, kRodBend);
  const Three<V> t = scaled(quarter, g.get3(i, kRodForceNow + 3));
  const V twist = g.get(i, kRodStepCompliance + 2);
  return {p.w, scaled_sum(g.get(i, kRodStepCompliance + 1), t, vector_part(p)), hn::MulAdd(twist, t.x, p.x),
          hn::MulAdd(twist, t.y, p.y)};
}
// C v and C^T v.
template <class V>
HWY_INLINE Three<V> times_bent(const BendRows<V>& c, const Three<V>& v) {
  return {hn::NegMulAdd(c.bent.z, v.y, hn::Mul(c.bent.y, v.z)),
          hn::NegMulAdd(c.bent.x, v.z, hn::Mul(c.bent.z, v.x)),
          hn::NegMulAdd(c.twist_y, v.x, hn::Mul(c.twist_x, v.y))};
}
template <class V>
HWY_INLINE Three<V> bent_times(const BendRows<V>& c, const Three<V>& v) {
  return {hn::NegMulAdd(c.twist_y, v.z, hn::Mul(c.bent.z, v.y)),
          hn::NegMulAdd(c.bent.z, v.x, hn::Mul(c.twist_x, v.z)),
          hn::NegMulAdd(c.bent.x, v.y, hn::Mul(c.bent.y, v.x))};
}

// What a force at distance l along z does to the segment's rotation, and how that point moves with it.
template <class V>
HWY_INLINE Three<V> lever(V l, const Three<V>& x, const Three<V>& y, const Three<V>& force) {
  return {hn::Neg(hn::Mul(l, dot(force, y))), hn::Mul(l, dot(force, x)), hn::Zero(hn::DFromV<V>())};
}
template <class V>
HWY_INLINE Three<V> swing(V l, const Three<V>& x, const Three<V>& y, const Three<V>& turn) {
  return less_scaled(hn::Mul(l, turn.x), y, scaled(hn::Mul(l, turn.y), x));
}

template <class G>
HWY_INLINE void linearise_segment(const G& g, size_t i) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const Four<V> q = g.get4(i, kRodNow);
  const SegmentAxes<V> axes = axes_of(q);
  g.set3(i, kRodAxes, axes.x);
  g.set3(i, kRodAxes + 3, axes.y);
  g.set3(i, kRodAxes + 6, axes.z);
  const V two = hn::Set(d, 2), inertia = hn::Mul(two, g.get(i, kRodInertia));
  const Three<V> turn = vector_part(relative(g.get4(i, kRodFreeTurn), q));
  g.set3(i, kRodImpulse, scaled(g.get(i, kRodMass), g.get3(i, kRodMove) - g.get3(i, kRodFreeMove)));
  g.set(i, kRodImpulse + 3, hn::Mul(inertia, turn.x));
  g.set(i, kRodImpulse + 4, hn::Mul(inertia, turn.y));
  g.set(i, kRodImpulse + 5, hn::Mul(hn::Mul(two, g.get(i, kRodAxialInertia)), turn.z));
  g.set(i, kRodStiffened, g.get(i, kRodInertia));
  g.set(i, kRodStiffened + 1, g.get(i, kRodAxialInertia));
}

template <class G>
HWY_INLINE void stiffen(const G& g, size_t i, typename G::V tension) {
  using V = typename G::V;
  g.set(i, kRodStiffened, hn::Add(g.get(i, kRodStiffened), hn::Max(tension, hn::Zero(hn::DFromV<V>()))));
}

template <class G>
HWY_INLINE void linearise_joint(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V two = hn::Set(d, 2);
  const Four<V> p = relative(g.get4(parent, kRodNow), g.get4(i, kRodNow));
  g.set4(i, kRodBend, p);
  const V l_a = g.get(i, kRodParentArm), l_b = g.get(i, kRodArm);
  const Three<V> z_a = g.get3(parent, kRodAxes + 6), z_b = g.get3(i, kRodAxes + 6);
  const Three<V> f = g.get3(i, kRodForceNow), t = g.get3(i, kRodForceNow + 3);
  const Three<V> gap = g.get3(i, kRodGap) + (g.get3(parent, kRodMove) - g.get3(i, kRodMove));
  const Three<V> stretch = scaled_sum(l_a, z_a, scaled_sum(l_b, z_b, gap));
  const V bend_compliance = g.get(i, kRodStepCompliance + 1);
  const Three<V> miss = scaled_sum(g.get(i, kRodStepCompliance), f, stretch);
  g.set3(i, kRodMiss, miss);
  const Three<V> bend = scaled(two, vector_part(p)) - g.get3(i, kRodStepRest);
  const Three<V> bend_miss = {hn::MulAdd(bend_compliance, t.x, bend.x),
                              hn::MulAdd(bend_compliance, t.y, bend.y),
                              hn::MulAdd(g.get(i, kRodStepCompliance + 2), t.z, bend.z)};
  g.set3(i, kRodMiss + 3, bend_miss);
  const V works = hn::Sub(hn::Set(d, 1), hn::Max(g.get(i, kRodFree), g.get(i, kRodTied)));
  const V held_miss = hn::Max(dot(miss, miss), dot(bend_miss, bend_miss));
  g.set_lane(kLaneHeldMiss, hn::Max(g.lane(kLaneHeldMiss), hn::Mul(works, held_miss)));
  const Three<V> lever_a = lever(l_a, g.get3(parent, kRodAxes), g.get3(parent, kRodAxes + 3), f);
  const Three<V> lever_b = lever(l_b, g.get3(i, kRodAxes), g.get3(i, kRodAxes + 3), f);
  g.set3(parent, kRodImpulse, g.get3(parent, kRodImpulse) - f);
  g.set3(parent, kRodImpulse + 3, (g.get3(parent, kRodImpulse + 3) - lever_a) + bend_by_child(p, t));
  g.set3(i, kRodImpulse, g.get3(i, kRodImpulse) + f);
  g.set3(i, kRodImpulse + 3, (g.get3(i, kRodImpulse + 3) - lever_b) - bend_by_parent(p, t));
  stiffen(g, parent, hn::Mul(l_a, dot(f, z_a)));
  stiffen(g, i, hn::Mul(l_b, dot(f, z_b)));
}

template <class G>
HWY_INLINE void linearise(const G& g, const RodJob& job) {
  g.set_lane(kLaneHeldMiss, hn::Zero(hn::DFromV<typename G::V>()));
  for (size_t i = 0; i < job.segments; ++i) linearise_segment(g, i);
  for (size_t i = 1; i < job.segments; ++i) linearise_joint(g, i, job.parents[i]);
}

template <size_t kWidth>
void rod_hold_forces(const RodJob& job) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    using V = typename std::decay_t<decltype(g)>::V;
    linearise(g, job);
    for (size_t i = 0; i < job.segments; ++i) {
      const V inverse_mass = g.get(i, kRodInverseMass), free = g.get(i, kRodFree);
      const V across = hn::Div(free, g.get(i, kRodInertia)),
              along = hn::Div(free, g.get(i, kRodAxialInertia));
      const Three<V> moment = g.get3(i, kRodImpulse + 3);
      const Three<V> turn = {hn::Mul(across, moment.x), hn::Mul(across, moment.y), hn::Mul(along, moment.z)};
      g.set3(i, kRodFreeMove, scaled_sum(inverse_mass, g.get3(i, kRodImpulse), g.get3(i, kRodFreeMove)));
      g.set4(i, kRodFreeTurn, turned(g.get4(i, kRodFreeTurn), turn));
    }
  });
}

// Moments turn along with both segments.
template <class G>
HWY_INLINE void turn_moments(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const Three<V> turns = g.get3(parent, kRodImpulse + 3) + g.get3(i, kRodImpulse + 3);
  const V quarter = hn::Set(hn::DFromV<V>(), 0.25f);
  g.set3(i, kRodMiss + 3,
         scaled_sum(quarter, cross(g.get3(i, kRodForceNow + 3), turns), g.get3(i, kRodMiss + 3)));
}

template <class G>
HWY_INLINE void change_segment(const G& g, size_t i, hn::Mask<hn::DFromV<typename G::V>> active,
                               typename G::V share) {
  using V = typename G::V;
  const auto moves = hn::And(active, g.free(i));
  const Three<V> move = scaled_sum(share, g.get3(i, kRodImpulse), g.get3(i, kRodMove));
  const Four<V> q = g.get4(i, kRodNow);
  g.set3(i, kRodMove, choose(moves, move, g.get3(i, kRodMove)));
  g.set4(i, kRodNow, choose(moves, turned(q, scaled(share, g.get3(i, kRodImpulse + 3))), q));
  for (uint32_t k = 0; i > 0 && k < 6; ++k) {
    const V force = g.get(i, kRodForceNow + k);
    const V changed = hn::MulAdd(share, g.get(i, kRodMiss + k), force);
    g.set(i, kRodForceNow + k, hn::IfThenElse(active, changed, force));
  }
}

// Half the square of the furthest that a point of a segment's axis moves, at most: (a + b)^2 <= 2 (a^2 +
// b^2).
template <class G>
HWY_INLINE typename G::V half_moved_square(const G& g, const RodJob& job) {
  using V = typename G::V;
  V largest = hn::Zero(hn::DFromV<V>());
  for (size_t i = 0; i < job.segments; ++i) {
    const Three<V> move = g.get3(i, kRodImpulse), turn = g.get3(i, kRodImpulse + 3);
    const V half = g.get(i, kRodHalfLength);
    largest = hn::Max(largest, hn::MulAdd(hn::Mul(half, half), dot(turn, turn), dot(move, move)));
  }
  return largest;
}

// Takes the changes in kRodImpulse and kRodMiss over, shortened where a segment would turn too far; strands
// that had converged stay as they were, with what they remember, for contacts may wake them again. Returns
// how many are not converged now.
template <class G>
HWY_INLINE uint32_t apply_changes(const G& g, const RodJob& job, typename G::V largest_square) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1), most = hn::Set(d, kRodLargestTurn_rad);
  const auto active = hn::Gt(g.lane(kLaneActive), zero);
  const V turn = hn::Sqrt(largest_square);
  // Also false where the turn is not a number: finish() reports that strand.
  const V left = hn::Max(turn, hn::Sqrt(g.lane(kLaneHeldMiss)));
  const auto goes_on = hn::And(active, hn::Gt(left, hn::Set(d, job.tolerance_rad)));
  V share = relaxation(g, job, goes_on);
  for (size_t i = 0; i < job.segments; ++i) {
    g.set3(i, kRodLastTurn, choose(active, g.get3(i, kRodImpulse + 3), g.get3(i, kRodLastTurn)));
  }
  share = hn::Div(hn::Mul(share, most), hn::Max(most, hn::Mul(share, turn)));
  for (size_t i = 1; i < job.segments; ++i) turn_moments(g, i, job.parents[i]);
  const V moved = hn::Mul(share, hn::Sqrt(hn::Mul(hn::Set(d, 2), half_moved_square(g, job))));
  g.set_lane(kLaneMoved, hn::IfThenElse(active, moved, g.lane(kLaneMoved)));
  for (size_t i = 0; i < job.segments; ++i) change_segment(g, i, active, share);
  g.set_lane(kLaneShare, hn::IfThenElse(active, share, g.lane(kLaneShare)));
  g.set_lane(kLaneIterations, hn::Add(g.lane(kLaneIterations), hn::IfThenElseZero(active, one)));
  g.set_lane(kLaneActive, hn::IfThenElseZero(goes_on, one));
  return static_cast<uint32_t>(hn::CountTrue(d, goes_on));
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

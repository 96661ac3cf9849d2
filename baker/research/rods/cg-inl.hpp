// cg-inl.hpp  The linear system by conjugate gradients, preconditioned by its diagonal (Shao et al. 2021,
// Algorithm 1).
//
//   (J W J^T + alpha) delta(f, t) = -(C + alpha (f, t)) + J W g,   delta x = W (J^T delta(f, t) - g)
// with W the inverse of mass and stiffened inertia and, of a segment that touches something, of its
// contacts' matrix. The matrix is applied, not stored; any tree. Its
// condition grows with segments^4: for comparing, and for what a good start leaves to do. A strand that is
// done stays as it is.
//
// An iteration ends where the residual r has r . P r <= tolerance^2 (r . P r of the step's first system
// from free motion without forces), P the inverse diagonal: not against the residual of the start it was
// given, so that a better start has less to do and a perfect one nothing.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Where the vectors stand: those of joints, then those of segments.
enum CgField : uint32_t {
  kCgResidual = kRodJointFactor,
  kCgDirection = kCgResidual + 6,
  kCgImage = kCgDirection + 6,
  kCgBody = kRodInertiaFactor,
  kCgDiagonal = kCgBody + 6,  // inverse
  kCgChange = kCgDiagonal + 6
};

// In a row that the root, which has no joint, leaves free: what residuals are measured by, squared.
inline constexpr size_t kCgScale = kRodGap;

template <class G>
HWY_INLINE Six<typename G::V> six(const G& g, size_t i, size_t field) {
  return {g.get3(i, field), g.get3(i, field + 3)};
}
template <class G>
HWY_INLINE void set_six(const G& g, size_t i, size_t field, const Six<typename G::V>& v) {
  g.set3(i, field, v.f);
  g.set3(i, field + 3, v.t);
}
template <class V>
HWY_INLINE Six<V> scaled_sum(V s, const Six<V>& a, const Six<V>& b) {
  return {scaled_sum(s, a.f, b.f), scaled_sum(s, a.t, b.t)};
}
template <class V>
HWY_INLINE V dot(const Six<V>& a, const Six<V>& b) {
  return hn::Add(dot(a.f, b.f), dot(a.t, b.t));
}
template <class V>
HWY_INLINE Three<V> times(const Three<V>& a, const Three<V>& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

// In place of contacts' matrices: L D L^T of them with mass and stiffened inertia.
template <class G>
HWY_INLINE void factorise_contacts(const G& g, const RodJob& job) {
  using V = typename G::V;
  for (size_t i = 0; g.contacts && i < job.segments; ++i) {
    if (!g.touches(i)) continue;
    const V m = g.get(i, kRodMass), bending = g.get(i, kRodStiffened);
    const V diagonal[6] = {m, m, m, bending, bending, g.get(i, kRodStiffened + 1)};
    Block<V> block;
    for (size_t k = 0; k < 21; ++k) block.at[k] = g.contact(i, k);
    for (size_t r = 0; r < 6; ++r) {
      block.at[triangle(r, r)] = hn::Add(block.at[triangle(r, r)], diagonal[r]);
    }
    factorise(&block);
    for (size_t k = 0; k < 21; ++k) g.set_contact(i, k, block.at[k]);
  }
}

template <class G>
HWY_INLINE Six<typename G::V> by_touching_mobility(const G& g, size_t i, const Six<typename G::V>& v) {
  using V = typename G::V;
  Block<V> block;
  for (size_t k = 0; k < 21; ++k) block.at[k] = g.contact(i, k);
  V x[6] = {v.f.x, v.f.y, v.f.z, v.t.x, v.t.y, v.t.z};
  forward(block, x);
  for (size_t k = 0; k < 6; ++k) x[k] = hn::Mul(x[k], block.at[triangle(k, k)]);
  backward(block, x);
  const V free = g.get(i, kRodFree);
  return {{hn::Mul(free, x[0]), hn::Mul(free, x[1]), hn::Mul(free, x[2])},
          {hn::Mul(free, x[3]), hn::Mul(free, x[4]), hn::Mul(free, x[5])}};
}

// W v of a segment.
template <class G>
HWY_INLINE Six<typename G::V> by_mobility(const G& g, size_t i, const Six<typename G::V>& v) {
  using V = typename G::V;
  if (g.touches(i)) return by_touching_mobility(g, i, v);
  const V free = g.get(i, kRodFree), across = hn::Div(free, g.get(i, kRodStiffened));
  const V about = hn::Div(free, g.get(i, kRodStiffened + 1));
  return {scaled(g.get(i, kRodInverseMass), v.f),
          {hn::Mul(across, v.t.x), hn::Mul(across, v.t.y), hn::Mul(about, v.t.z)}};
}

// W's diagonal; of a segment that touches something that of D^-1, which is positive as well.
template <class G>
HWY_INLINE Six<typename G::V> mobility_scale(const G& g, size_t i) {
  using V = typename G::V;
  const V free = g.get(i, kRodFree), one = hn::Set(hn::DFromV<V>(), 1);
  if (!g.touches(i)) return by_mobility(g, i, Six<V>{{one, one, one}, {one, one, one}});
  V w[6];
  for (size_t k = 0; k < 6; ++k) w[k] = hn::Mul(free, g.contact(i, triangle(k, k)));
  return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
}

// Bodies += J^T of a joint's forces.
template <class G>
HWY_INLINE void add_impulse(const G& g, size_t i, size_t parent, const Six<typename G::V>& force) {
  using V = typename G::V;
  const BendRows<V> c = bend_rows(g, i);
  const Six<V> a = six(g, parent, kCgBody), b = six(g, i, kCgBody);
  const Three<V> arm_a =
      lever(g.get(i, kRodParentArm), g.get3(parent, kRodAxes), g.get3(parent, kRodAxes + 3), force.f);
  const Three<V> arm_b = lever(g.get(i, kRodArm), g.get3(i, kRodAxes), g.get3(i, kRodAxes + 3), force.f);
  const Three<V> straight = scaled(c.w, force.t), bent = bent_times(c, force.t);
  set_six(g, parent, kCgBody, {a.f + force.f, (a.t + arm_a) + (bent - straight)});
  set_six(g, i, kCgBody, {b.f - force.f, (b.t + arm_b) + (bent + straight)});
}

// J of the bodies at a joint; nothing where both ends are given.
template <class G>
HWY_INLINE Six<typename G::V> joint_change(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const Six<V> a = six(g, parent, kCgBody), b = six(g, i, kCgBody);
  const BendRows<V> c = bend_rows(g, i);
  const Three<V> at_a =
      swing(g.get(i, kRodParentArm), g.get3(parent, kRodAxes), g.get3(parent, kRodAxes + 3), a.t);
  const Three<V> at_b = swing(g.get(i, kRodArm), g.get3(i, kRodAxes), g.get3(i, kRodAxes + 3), b.t);
  return {(a.f - b.f) + (at_a + at_b), scaled_sum(c.w, b.t - a.t, times_bent(c, a.t + b.t))};
}

template <class G>
HWY_INLINE Six<typename G::V> joint_compliance(const G& g, size_t i) {
  using V = typename G::V;
  const V stretch = g.get(i, kRodStepCompliance), bend = g.get(i, kRodStepCompliance + 1);
  return {{stretch, stretch, stretch}, {bend, bend, g.get(i, kRodStepCompliance + 2)}};
}

// Bodies = W J^T of the joints' vectors in `field`.
template <class G>
HWY_INLINE void spread(const G& g, const RodJob& job, size_t field) {
  using V = typename G::V;
  const V zero = hn::Zero(hn::DFromV<V>());
  for (size_t i = 0; i < job.segments; ++i) {
    set_six(g, i, kCgBody, Six<V>{{zero, zero, zero}, {zero, zero, zero}});
  }
  for (size_t i = 1; i < job.segments; ++i) add_impulse(g, i, job.parents[i], six(g, i, field));
  for (size_t i = 0; i < job.segments; ++i) set_six(g, i, kCgBody, by_mobility(g, i, six(g, i, kCgBody)));
}

// 1 / diagonal of J W J^T + alpha; nothing where both ends are given.
template <class G>
HWY_INLINE Six<typename G::V> inverse_diagonal(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), least = hn::Set(d, 1e-30f);
  const Six<V> soft = joint_compliance(g, i);
  V diagonal[6] = {soft.f.x, soft.f.y, soft.f.z, soft.t.x, soft.t.y, soft.t.z};
  V a[3][3];
  bend_matrix(bend_rows(g, i), a);
  for (const size_t s : {parent, i}) {
    const Six<V> w = mobility_scale(g, s);
    const V l = g.get(s, kRodHalfLength), k = hn::Mul(hn::Mul(l, l), w.t.x);
    const V turn[3] = {w.t.x, w.t.y, w.t.z};
    for (size_t r = 0; r < 3; ++r) {
      const V z = g.get(s, kRodAxes + 6 + r);
      diagonal[r] = hn::Add(diagonal[r], hn::MulAdd(k, hn::NegMulAdd(z, z, one), w.f.x));
      for (size_t c = 0; c < 3; ++c) {
        const V by = a[r][c];
        diagonal[3 + r] = hn::MulAdd(hn::Mul(by, by), turn[c], diagonal[3 + r]);
      }
    }
  }
  const V works = hn::Sub(one, g.get(i, kRodTied));
  for (V& x : diagonal) x = hn::Div(works, hn::Max(x, least));
  return {{diagonal[0], diagonal[1], diagonal[2]}, {diagonal[3], diagonal[4], diagonal[5]}};
}

template <class V>
HWY_INLINE Six<V> times(const Six<V>& a, const Six<V>& b) {
  return {times(a.f, b.f), times(a.t, b.t)};
}

// Residual, first direction and zero change; returns residual . preconditioned residual.
template <class G>
HWY_INLINE typename G::V start_gradient(const G& g, const RodJob& job) {
  using V = typename G::V;
  V sum = hn::Zero(hn::DFromV<V>());
  for (size_t i = 0; i < job.segments; ++i) {
    set_six(g, i, kCgBody, by_mobility(g, i, six(g, i, kRodImpulse)));
  }
  for (size_t i = 1; i < job.segments; ++i) {
    const Six<V> pulled = joint_change(g, i, job.parents[i]), miss = six(g, i, kRodMiss);
    const Six<V> residual = {pulled.f - miss.f, pulled.t - miss.t};
    // After the bodies of this joint were read: kCgDiagonal lies behind them in the same row.
    const Six<V> inverse = inverse_diagonal(g, i, job.parents[i]), direction = times(inverse, residual);
    set_six(g, i, kCgDiagonal, inverse);
    set_six(g, i, kCgResidual, residual);
    set_six(g, i, kCgDirection, direction);
    set_six(g, i, kCgChange, Six<V>{miss.f - miss.f, miss.t - miss.t});
    sum = hn::Add(sum, dot(residual, direction));
  }
  return sum;
}

// One iteration of the lanes in `active`; `energy` is residual . preconditioned residual, before and after.
template <class G, class M>
HWY_INLINE typename G::V improve(const G& g, const RodJob& job, M active, typename G::V energy) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d);
  V curvature = zero, next = zero;
  spread(g, job, kCgDirection);
  for (size_t i = 1; i < job.segments; ++i) {
    const Six<V> direction = six(g, i, kCgDirection), moved = joint_change(g, i, job.parents[i]);
    const Six<V> soft = times(joint_compliance(g, i), direction);
    const Six<V> image = {moved.f + soft.f, moved.t + soft.t};
    set_six(g, i, kCgImage, image);
    curvature = hn::Add(curvature, dot(direction, image));
  }
  const auto goes = hn::And(active, hn::Gt(curvature, zero));
  const V step = hn::IfThenElseZero(goes, hn::Div(energy, curvature));
  for (size_t i = 1; i < job.segments; ++i) {
    set_six(g, i, kCgChange, scaled_sum(step, six(g, i, kCgDirection), six(g, i, kCgChange)));
    const Six<V> residual = scaled_sum(hn::Neg(step), six(g, i, kCgImage), six(g, i, kCgResidual));
    set_six(g, i, kCgResidual, residual);
    next = hn::Add(next, dot(residual, times(six(g, i, kCgDiagonal), residual)));
  }
  const V share = hn::IfThenElseZero(goes, hn::Div(next, energy));
  for (size_t i = 1; i < job.segments; ++i) {
    const Six<V> ahead = times(six(g, i, kCgDiagonal), six(g, i, kCgResidual));
    set_six(g, i, kCgDirection, scaled_sum(share, six(g, i, kCgDirection), ahead));
  }
  return next;
}

// Below this share of what it starts from a residual is rounding. It ends what is measured by nothing: a
// strand that free motion would leave as it is.
inline constexpr float kCgRounding = 1e-6f;

template <class G>
HWY_INLINE void solve_gradient(const G& g, const RodJob& job, const baker::CgLimits& limits,
                               uint32_t* iterations) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d);
  V energy = start_gradient(g, job);
  const V enough = hn::Max(hn::Mul(hn::Set(d, limits.tolerance * limits.tolerance), g.get(0, kCgScale)),
                           hn::Mul(hn::Set(d, kCgRounding * kCgRounding), energy));
  auto active = hn::And(hn::Gt(g.lane(kLaneActive), zero), hn::Gt(energy, enough));
  for (uint32_t k = 0; k < limits.max_iterations && !hn::AllFalse(d, active); ++k) {
    *iterations += static_cast<uint32_t>(hn::CountTrue(d, active));
    energy = improve(g, job, active, energy);
    active = hn::And(active, hn::Gt(energy, enough));
  }
}

// delta x = W (J^T delta(f, t) - g) and the change where apply_changes reads them.
template <class G>
HWY_INLINE typename G::V change_bodies(const G& g, const RodJob& job) {
  using V = typename G::V;
  V largest = hn::Zero(hn::DFromV<V>());
  spread(g, job, kCgChange);
  for (size_t i = 0; i < job.segments; ++i) {
    const Six<V> pulled = by_mobility(g, i, six(g, i, kRodImpulse)), body = six(g, i, kCgBody);
    const Six<V> change = {body.f - pulled.f, body.t - pulled.t};
    set_six(g, i, kRodImpulse, change);
    if (i > 0) set_six(g, i, kRodMiss, six(g, i, kCgChange));
    largest = hn::Max(largest, dot(change.t, change.t));
  }
  return largest;
}

template <size_t kWidth>
void rod_measure_cg(const RodJob& job) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    const LanesOf<kWidth> d;
    for (size_t i = 0; i < job.segments; ++i) start_iterate(g, i, hn::Zero(d));
    linearise(g, job);
    g.set(0, kCgScale, start_gradient(g, job));
    for (size_t i = 0; i < job.segments; ++i) start_iterate(g, i, start_square(d, job));
  });
}

template <size_t kWidth>
uint32_t rod_cg(const RodJob& job, const baker::CgLimits& limits, uint32_t* iterations) {
  uint32_t active = 0;
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    linearise(g, job);
    add_contact_forces(g, job);
    factorise_contacts(g, job);
    solve_gradient(g, job, limits, iterations);
    active += apply_changes(g, job, change_bodies(g, job));
  });
  return active;
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// local-inl.hpp  The linear system by block Gauss-Seidel over joints, as XPBD solves it (Macklin 2016;
// Kugelstadt, Schoemer 2016, Section 4).
//
// A visit to a joint solves its own six rows exactly and moves both of its segments at once:
//   delta = (J W J^T + alpha)^-1 (-(C + alpha (f, t)) - alpha change - J x),  change += delta,
//   x += W J^T delta
// from x = -W g, so that x = W (J^T change - g) holds after each: what the joints carry is what the segments
// are given, and where sweeps go on to the end it is the direct solver's answer. Sweeps go from the root to
// the leaves: back and forth by turns left twice the stretch. Errors that span many segments fade slowly,
// with segments^2 sweeps and more: a strand has converged when, besides, the last sweep found no joint
// further off than the tolerance.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Beside kCgBody, x, and kCgChange: 1 over inertia about x and y, and about z.
inline constexpr size_t kLocalMobility = kCgDiagonal;

template <class G>
HWY_INLINE Six<typename G::V> by_kept_mobility(const G& g, size_t i, const Six<typename G::V>& v) {
  const typename G::V across = g.get(i, kLocalMobility), about = g.get(i, kLocalMobility + 1);
  return {scaled(g.get(i, kRodInverseMass), v.f),
          {hn::Mul(across, v.t.x), hn::Mul(across, v.t.y), hn::Mul(about, v.t.z)}};
}

// x = -W g, no change.
template <class G>
HWY_INLINE void start_sweeps(const G& g, size_t i) {
  using V = typename G::V;
  const V zero = hn::Zero(hn::DFromV<V>()), free = g.get(i, kRodFree);
  g.set(i, kLocalMobility, hn::Div(free, g.get(i, kRodStiffened)));
  g.set(i, kLocalMobility + 1, hn::Div(free, g.get(i, kRodStiffened + 1)));
  const Six<V> pulled = by_kept_mobility(g, i, six(g, i, kRodImpulse)),
               none = {{zero, zero, zero}, {zero, zero, zero}};
  set_six(g, i, kCgBody, Six<V>{none.f - pulled.f, none.t - pulled.t});
  set_six(g, i, kCgChange, none);
}

// A joint's rows of rotation of one segment: three of stretch, three of bend.
template <class V>
struct TurnRows {
  HWY_INLINE TurnRows() {}  // written out, for one that a compiler makes up would not be of this target
  V at[6][3];
};
// `side` is 1 for the child, -1 for the parent.
template <class G>
HWY_INLINE void turn_rows(const G& g, size_t segment, size_t joint, size_t arm, typename G::V side,
                          TurnRows<typename G::V>* rows) {
  using V = typename G::V;
  V by_x[3], by_y[3], a[3][3];
  lever_rows(g, segment, g.get(joint, arm), by_x, by_y);
  bend_matrix(bend_rows(g, joint), a);
  SINEW_UNROLL
  for (size_t r = 0; r < 3; ++r) {
    rows->at[r][0] = by_x[r];
    rows->at[r][1] = by_y[r];
    rows->at[r][2] = hn::Zero(hn::DFromV<V>());
    SINEW_UNROLL
    for (size_t k = 0; k < 3; ++k) rows->at[3 + r][k] = r == k ? hn::Mul(side, a[r][k]) : a[r][k];
  }
}

// Adds one segment's share of J W J^T.
template <class G>
HWY_INLINE void add_mobility(const G& g, size_t segment, const TurnRows<typename G::V>& rows,
                             Block<typename G::V>* out) {
  using V = typename G::V;
  const V about[3] = {g.get(segment, kLocalMobility), g.get(segment, kLocalMobility),
                      g.get(segment, kLocalMobility + 1)};
  SINEW_UNROLL
  for (size_t r = 0; r < 6; ++r) {
    SINEW_UNROLL
    for (size_t c = 0; c <= r; ++c) {
      V sum = out->at[triangle(r, c)];
      if (r < 3 && r == c) sum = hn::Add(sum, g.get(segment, kRodInverseMass));
      SINEW_UNROLL
      for (size_t k = 0; k < 3; ++k) {
        sum = hn::MulAdd(hn::Mul(about[k], rows.at[r][k]), rows.at[c][k], sum);
      }
      out->at[triangle(r, c)] = sum;
    }
  }
}

// J W J^T + alpha of a joint, factorised; one more on the diagonal where neither end moves.
template <class G>
HWY_INLINE void factorise_joint(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), tied = g.get(i, kRodTied);
  Block<V> block;
  SINEW_UNROLL
  for (size_t r = 0; r < 6; ++r) {
    SINEW_UNROLL
    for (size_t c = 0; c < r; ++c) block.at[triangle(r, c)] = hn::Zero(d);
    block.at[triangle(r, r)] = hn::Add(tied, g.get(i, kRodStepCompliance + (r < 3 ? 0 : r < 5 ? 1 : 2)));
  }
  TurnRows<V> rows;
  turn_rows(g, parent, i, kRodParentArm, hn::Neg(one), &rows);
  add_mobility(g, parent, rows, &block);
  turn_rows(g, i, i, kRodArm, one, &rows);
  add_mobility(g, i, rows, &block);
  factorise(&block);
  set_block(g, i, kRodJointFactor, block);
}

// x += W J^T of a joint's forces.
template <class G>
HWY_INLINE void move_both(const G& g, size_t i, size_t parent, const Six<typename G::V>& force) {
  using V = typename G::V;
  const BendRows<V> c = bend_rows(g, i);
  const Three<V> arm_a =
      lever(g.get(i, kRodParentArm), g.get3(parent, kRodAxes), g.get3(parent, kRodAxes + 3), force.f);
  const Three<V> arm_b = lever(g.get(i, kRodArm), g.get3(i, kRodAxes), g.get3(i, kRodAxes + 3), force.f);
  const Three<V> straight = scaled(c.w, force.t), bent = bent_times(c, force.t);
  const Six<V> a = by_kept_mobility(g, parent, {force.f, arm_a + (bent - straight)});
  const Six<V> b = by_kept_mobility(g, i, {force.f, arm_b + (bent + straight)});
  const Six<V> x_a = six(g, parent, kCgBody), x_b = six(g, i, kCgBody);
  set_six(g, parent, kCgBody, {x_a.f + a.f, x_a.t + a.t});
  set_six(g, i, kCgBody, {x_b.f - b.f, x_b.t + b.t});
}

// Returns the square of how far off the joint was found, in gap or in bend.
template <class G>
HWY_INLINE typename G::V visit_joint(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const V works = hn::Sub(hn::Set(hn::DFromV<V>(), 1), g.get(i, kRodTied));
  const Six<V> change = six(g, i, kCgChange), soft = times(joint_compliance(g, i), change);
  const Six<V> moved = joint_change(g, i, parent), miss = six(g, i, kRodMiss);
  const Three<V> gap = scaled(works, miss.f + (moved.f + soft.f)),
                 bend = scaled(works, miss.t + (moved.t + soft.t));
  const Block<V> block = get_block(g, i, kRodJointFactor);
  V delta[6] = {hn::Neg(gap.x),  hn::Neg(gap.y),  hn::Neg(gap.z),
                hn::Neg(bend.x), hn::Neg(bend.y), hn::Neg(bend.z)};
  forward(block, delta);
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) delta[k] = hn::Mul(delta[k], block.at[triangle(k, k)]);
  backward(block, delta);
  const Six<V> force = {{delta[0], delta[1], delta[2]}, {delta[3], delta[4], delta[5]}};
  set_six(g, i, kCgChange, {change.f + force.f, change.t + force.t});
  move_both(g, i, parent, force);
  return hn::Max(dot(gap, gap), dot(bend, bend));
}

// Returns the square of how far off the worst joint of the last sweep was.
template <class G>
HWY_INLINE typename G::V sweep(const G& g, const RodJob& job, uint32_t sweeps) {
  using V = typename G::V;
  V worst = hn::Zero(hn::DFromV<V>());
  for (uint32_t k = 0; k < sweeps; ++k) {
    worst = hn::Zero(hn::DFromV<V>());
    for (size_t i = 1; i < job.segments; ++i) worst = hn::Max(worst, visit_joint(g, i, job.parents[i]));
  }
  return worst;
}

// x and the change where apply_changes reads them; returns the square of the largest turn.
template <class G>
HWY_INLINE typename G::V take_sweeps(const G& g, const RodJob& job) {
  using V = typename G::V;
  V largest = hn::Zero(hn::DFromV<V>());
  for (size_t i = 0; i < job.segments; ++i) {
    const Six<V> body = six(g, i, kCgBody);
    set_six(g, i, kRodImpulse, body);
    if (i > 0) set_six(g, i, kRodMiss, six(g, i, kCgChange));
    largest = hn::Max(largest, dot(body.t, body.t));
  }
  return largest;
}

template <size_t kWidth>
uint32_t rod_local(const RodJob& job, uint32_t sweeps) {
  uint32_t active = 0;
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    linearise(g, job);
    for (size_t i = 0; i < job.segments; ++i) start_sweeps(g, i);
    for (size_t i = 1; i < job.segments; ++i) factorise_joint(g, i, job.parents[i]);
    g.set_lane(kLaneHeldMiss, sweep(g, job, sweeps));
    active += apply_changes(g, job, take_sweeps(g, job));
  });
  return active;
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

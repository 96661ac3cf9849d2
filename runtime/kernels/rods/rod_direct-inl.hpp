// rod_direct-inl.hpp  The linear system of a chain or tree, solved exactly in O(segments).
//
// L D L^T of the mixed system, from the leaves to the root, a segment and its joint at a time (Deul et al.
// 2018, Section 4.3; as articulated bodies, Featherstone 1983). With S the inertia of a segment and all that
// hangs on it:
//   S_i = M_i + sum over children K_c        T_i = alpha + J_b S_i^{-1} J_b^T         K_i = J_a^T T_i^{-1}
//   J_a
// Only positive matrices are added, none subtracted, so that single precision holds where the shorter way, L
// D L^T of the multipliers' own block-tridiagonal system, loses all digits (its condition grows with
// segments^4). Rows of a segment: three of place, three of rotation; of a joint: three of stretch, three of
// bend.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

constexpr size_t triangle(size_t row, size_t column) { return row * (row + 1) / 2 + column; }

// Below this share of its diagonal a pivot is rounding.
inline constexpr float kLeastPivot = 2e-7f;
// Given to the matrix, not to the equations, where a joint's child is held: what is held twice may have no
// answer, and otherwise a few more iterations find it. Bend always has one, and asks only for a number above
// zero: a stiff rod behind a softer joint would take its pose in hundreds of iterations.
inline constexpr float kHeldCompliance = 1e-3f, kHeldBendCompliance = 1e-7f;

// A symmetric 6x6 by its lower triangle; after factorise() L below D^-1.
template <class V>
struct Block {
  HWY_INLINE Block() {}  // written out, for one that a compiler makes up would not be of this target
  V at[21];
};

template <class V>
HWY_INLINE void factorise(Block<V>* s) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), least = hn::Set(d, kLeastPivot);
  V floor[6];
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) floor[k] = hn::Mul(least, s->at[triangle(k, k)]);
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) {
    const V inverse = hn::Div(one, hn::Max(s->at[triangle(k, k)], floor[k]));
    V column[6];
    SINEW_UNROLL
    for (size_t r = k + 1; r < 6; ++r) column[r] = hn::Mul(s->at[triangle(r, k)], inverse);
    SINEW_UNROLL
    for (size_t r = k + 1; r < 6; ++r) {
      SINEW_UNROLL
      for (size_t c = k + 1; c <= r; ++c) {
        s->at[triangle(r, c)] = hn::NegMulAdd(column[r], s->at[triangle(c, k)], s->at[triangle(r, c)]);
      }
    }
    SINEW_UNROLL
    for (size_t r = k + 1; r < 6; ++r) s->at[triangle(r, k)] = column[r];
    s->at[triangle(k, k)] = inverse;
  }
}

// x becomes L^-1 x; entries before `first` are zero.
template <size_t kFirst = 0, class V>
HWY_INLINE void forward(const Block<V>& s, V (&x)[6]) {
  SINEW_UNROLL
  for (size_t r = kFirst + 1; r < 6; ++r) {
    SINEW_UNROLL
    for (size_t c = kFirst; c < r; ++c) x[r] = hn::NegMulAdd(s.at[triangle(r, c)], x[c], x[r]);
  }
}
template <class V>
HWY_INLINE void backward(const Block<V>& s, V (&x)[6]) {
  SINEW_UNROLL
  for (size_t r = 5; r > 0; --r) {
    SINEW_UNROLL
    for (size_t c = 0; c < r; ++c) x[c] = hn::NegMulAdd(s.at[triangle(r, c)], x[r], x[c]);
  }
}

template <class G>
HWY_INLINE Block<typename G::V> get_block(const G& g, size_t i, size_t field) {
  Block<typename G::V> out;
  SINEW_UNROLL
  for (size_t k = 0; k < 21; ++k) out.at[k] = g.get(i, field + k);
  return out;
}
template <class G>
HWY_INLINE void set_block(const G& g, size_t i, size_t field, const Block<typename G::V>& block) {
  SINEW_UNROLL
  for (size_t k = 0; k < 21; ++k) g.set(i, field + k, block.at[k]);
}
template <class G>
HWY_INLINE void get_six(const G& g, size_t i, size_t field, typename G::V (&out)[6]) {
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) out[k] = g.get(i, field + k);
}
template <class G>
HWY_INLINE void set_six(const G& g, size_t i, size_t field, const typename G::V (&values)[6]) {
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) g.set(i, field + k, values[k]);
}

// S = M and the impulse -g, before the children add theirs.
template <class G>
HWY_INLINE void start_segment(const G& g, size_t i) {
  using V = typename G::V;
  const V zero = hn::Zero(hn::DFromV<V>());
  const V m = g.get(i, kRodMass), bending = g.get(i, kRodStiffened);
  const V diagonal[6] = {m, m, m, bending, bending, g.get(i, kRodStiffened + 1)};
  SINEW_UNROLL
  for (size_t r = 0; r < 6; ++r) {
    SINEW_UNROLL
    for (size_t c = 0; c < r; ++c) g.set(i, kRodInertiaFactor + triangle(r, c), zero);
    g.set(i, kRodInertiaFactor + triangle(r, r), diagonal[r]);
    g.set(i, kRodImpulse + r, hn::Neg(g.get(i, kRodImpulse + r)));
  }
}

// A = w + C, how bend changes with the child's rotation; by the parent's off its diagonal the same, on it
// minus.
template <class V>
HWY_INLINE void bend_matrix(const BendRows<V>& c, V (&a)[3][3]) {
  const V out[3][3] = {{c.w, hn::Neg(c.bent.z), c.bent.y},
                       {c.bent.z, c.w, hn::Neg(c.bent.x)},
                       {hn::Neg(c.twist_y), c.twist_x, c.w}};
  SINEW_UNROLL
  for (size_t r = 0; r < 3; ++r) {
    SINEW_UNROLL
    for (size_t c = 0; c < 3; ++c) a[r][c] = out[r][c];
  }
}

// Rows of rotation of J^T's stretch columns: -l y and l x of a segment.
template <class G>
HWY_INLINE void lever_rows(const G& g, size_t i, typename G::V l, typename G::V (&by_x)[3],
                           typename G::V (&by_y)[3]) {
  SINEW_UNROLL
  for (size_t k = 0; k < 3; ++k) {
    by_x[k] = hn::Neg(hn::Mul(l, g.get(i, kRodAxes + 3 + k)));
    by_y[k] = hn::Mul(l, g.get(i, kRodAxes + k));
  }
}

// T = alpha + J_b S^-1 J_b^T and its right side -(C + alpha (f, t)) - J_b S^-1 (impulse); S comes factorised,
// z is L^-1 (impulse).
template <class G>
HWY_INLINE void joint_through_child(const G& g, size_t i, const Block<typename G::V>& s,
                                    const typename G::V (&z)[6], const typename G::V (&a)[3][3],
                                    Block<typename G::V>* t, typename G::V (&right)[6]) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1), free = g.get(i, kRodFree);
  V by_x[3], by_y[3], x[6][6];  // x[column] = L^-1 J_b^T, columns of bend zero in the rows of place
  lever_rows(g, i, g.get(i, kRodArm), by_x, by_y);
  SINEW_UNROLL
  for (size_t c = 0; c < 3; ++c) {
    SINEW_UNROLL
    for (size_t r = 0; r < 3; ++r) x[c][r] = r == c ? hn::Neg(one) : zero;
    x[c][3] = by_x[c];
    x[c][4] = by_y[c];
    x[c][5] = zero;
    forward(s, x[c]);
    SINEW_UNROLL
    for (size_t r = 0; r < 3; ++r) {
      x[3 + c][r] = zero;
      x[3 + c][3 + r] = a[c][r];
    }
    forward<3>(s, x[3 + c]);
  }
  V inverse[6];
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) inverse[k] = hn::Mul(free, s.at[triangle(k, k)]);
  const V held = hn::Sub(one, free);
  const V stretch = hn::MulAdd(hn::Set(d, kHeldCompliance), held, g.get(i, kRodStepCompliance));
  const V held_bend = hn::Mul(hn::Set(d, kHeldBendCompliance), held);
  const V bend = hn::Add(held_bend, g.get(i, kRodStepCompliance + 1));
  const V twist = hn::Add(held_bend, g.get(i, kRodStepCompliance + 2));
  const V diagonal[6] = {stretch, stretch, stretch, bend, bend, twist};
  SINEW_UNROLL
  for (size_t r = 0; r < 6; ++r) {
    const size_t from = r < 3 ? 0 : 3;
    V scaled_row[6];
    SINEW_UNROLL
    for (size_t k = from; k < 6; ++k) scaled_row[k] = hn::Mul(inverse[k], x[r][k]);
    SINEW_UNROLL
    for (size_t c = 0; c <= r; ++c) {
      V sum = r == c ? diagonal[r] : zero;
      SINEW_UNROLL
      for (size_t k = from; k < 6; ++k) sum = hn::MulAdd(scaled_row[k], x[c][k], sum);
      t->at[triangle(r, c)] = sum;
    }
    V sum = hn::Neg(g.get(i, kRodMiss + r));
    SINEW_UNROLL
    for (size_t k = from; k < 6; ++k) sum = hn::NegMulAdd(scaled_row[k], z[k], sum);
    right[r] = hn::Mul(hn::Sub(one, g.get(i, kRodTied)), sum);
  }
}

// K = J_a^T T^-1 J_a and J_a^T T^-1 (right side) added to the parent; T comes factorised, u is L^-1 (right
// side).
template <class G>
HWY_INLINE void add_to_parent(const G& g, size_t i, size_t parent, const Block<typename G::V>& t,
                              const typename G::V (&u)[6], const typename G::V (&a)[3][3]) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1);
  V by_x[3], by_y[3], y[6][6];  // y[column] = L^-1 J_a
  lever_rows(g, parent, g.get(i, kRodParentArm), by_x, by_y);
  SINEW_UNROLL
  for (size_t c = 0; c < 3; ++c) {
    SINEW_UNROLL
    for (size_t r = 0; r < 3; ++r) {
      y[c][r] = r == c ? one : zero;
      y[c][3 + r] = zero;
      y[3 + c][3 + r] = r == c ? hn::Neg(a[r][c]) : a[r][c];
    }
    forward(t, y[c]);
  }
  SINEW_UNROLL
  for (size_t r = 0; r < 3; ++r) {
    y[3][r] = by_x[r];
    y[4][r] = by_y[r];
    y[5][r] = zero;
  }
  forward(t, y[3]);
  forward(t, y[4]);
  forward<3>(t, y[5]);
  SINEW_UNROLL
  for (size_t r = 0; r < 6; ++r) {
    const size_t from = r < 3 ? r : r < 5 ? 0 : 3;
    V scaled_row[6];
    SINEW_UNROLL
    for (size_t k = from; k < 6; ++k) scaled_row[k] = hn::Mul(t.at[triangle(k, k)], y[r][k]);
    SINEW_UNROLL
    for (size_t c = 0; c <= r; ++c) {
      V sum = g.get(parent, kRodInertiaFactor + triangle(r, c));
      SINEW_UNROLL
      for (size_t k = c < 3 ? (from > c ? from : c) : from; k < 6; ++k) {
        sum = hn::MulAdd(scaled_row[k], y[c][k], sum);
      }
      g.set(parent, kRodInertiaFactor + triangle(r, c), sum);
    }
    V sum = g.get(parent, kRodImpulse + r);
    SINEW_UNROLL
    for (size_t k = from; k < 6; ++k) sum = hn::MulAdd(scaled_row[k], u[k], sum);
    g.set(parent, kRodImpulse + r, sum);
  }
}

// A segment, then its joint; what is left stands in the parent's record.
template <class G>
HWY_INLINE void eliminate_segment(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  Block<V> s = get_block(g, i, kRodInertiaFactor), t;
  V z[6], right[6], a[3][3];
  get_six(g, i, kRodImpulse, z);
  factorise(&s);
  forward(s, z);
  set_block(g, i, kRodInertiaFactor, s);
  set_six(g, i, kRodImpulse, z);
  bend_matrix(bend_rows(g, i), a);
  joint_through_child(g, i, s, z, a, &t, right);
  factorise(&t);
  forward(t, right);
  set_block(g, i, kRodJointFactor, t);
  set_six(g, i, kRodMiss, right);
  add_to_parent(g, i, parent, t, right, a);
}

// delta x of a segment from z + L^-1 (added impulse); returns the square of its turn.
template <class G>
HWY_INLINE typename G::V solve_segment(const G& g, size_t i, typename G::V (&x)[6]) {
  using V = typename G::V;
  const Block<V> s = get_block(g, i, kRodInertiaFactor);
  const auto free = g.free(i);
  forward(s, x);
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) {
    x[k] = hn::IfThenElseZero(free, hn::Mul(s.at[triangle(k, k)], hn::Add(x[k], g.get(i, kRodImpulse + k))));
  }
  backward(s, x);
  set_six(g, i, kRodImpulse, x);
  return hn::MulAdd(x[5], x[5], hn::MulAdd(x[4], x[4], hn::Mul(x[3], x[3])));
}

// delta (f, t) = T^-1 (right side - J_a delta x_a), then the child's delta x.
template <class G>
HWY_INLINE typename G::V substitute(const G& g, size_t i, size_t parent) {
  using V = typename G::V;
  const Block<V> t = get_block(g, i, kRodJointFactor);
  const BendRows<V> c = bend_rows(g, i);
  const Three<V> move = g.get3(parent, kRodImpulse), turn = g.get3(parent, kRodImpulse + 3);
  const Three<V> stretch =
      move + swing(g.get(i, kRodParentArm), g.get3(parent, kRodAxes), g.get3(parent, kRodAxes + 3), turn);
  const Three<V> bend = scaled(c.w, turn) - times_bent(c, turn);
  V x[6] = {stretch.x, stretch.y, stretch.z, hn::Neg(bend.x), hn::Neg(bend.y), hn::Neg(bend.z)};
  forward(t, x);
  SINEW_UNROLL
  for (size_t k = 0; k < 6; ++k) {
    x[k] = hn::Mul(t.at[triangle(k, k)], hn::Sub(g.get(i, kRodMiss + k), x[k]));
  }
  backward(t, x);
  set_six(g, i, kRodMiss, x);
  const Three<V> force = {x[0], x[1], x[2]}, moment = {x[3], x[4], x[5]};
  const Three<V> arm = lever(g.get(i, kRodArm), g.get3(i, kRodAxes), g.get3(i, kRodAxes + 3), force) +
                       scaled_sum(c.w, moment, bent_times(c, moment));
  V impulse[6] = {hn::Neg(force.x), hn::Neg(force.y), hn::Neg(force.z), arm.x, arm.y, arm.z};
  return solve_segment(g, i, impulse);
}

template <size_t kWidth>
uint32_t rod_direct(const RodJob& job) {
  uint32_t active = 0;
  for_active_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    using V = typename std::decay_t<decltype(g)>::V;
    linearise(g, job);
    add_contact_forces(g, job);
    for (size_t i = 0; i < job.segments; ++i) start_segment(g, i);
    add_contact_matrices(g, job);
    for (size_t i = job.segments - 1; i > 0; --i) eliminate_segment(g, i, job.parents[i]);
    Block<V> root = get_block(g, 0, kRodInertiaFactor);
    V z[6], none[6];
    get_six(g, 0, kRodImpulse, z);
    factorise(&root);
    forward(root, z);
    set_block(g, 0, kRodInertiaFactor, root);
    set_six(g, 0, kRodImpulse, z);
    SINEW_UNROLL
    for (size_t k = 0; k < 6; ++k) none[k] = hn::Zero(hn::DFromV<V>());
    V largest = solve_segment(g, 0, none);
    for (size_t i = 1; i < job.segments; ++i) largest = hn::Max(largest, substitute(g, i, job.parents[i]));
    active += apply_changes(g, job, largest);
  });
  return active;
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

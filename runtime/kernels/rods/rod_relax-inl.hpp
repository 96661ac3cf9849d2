// rod_relax-inl.hpp  How much of an iteration's change a strand takes, from how the last two compare.
//
// Aitken's secant (Irons, Tuck 1969) on the segments' rotations: with r the changes asked for and s the share
// of the last one that was taken,  s' = s r_last.(r_last - r) / |r_last - r|^2. What approaches its end
// slowly from one side takes longer steps, what swings about it shorter ones. From the third iteration on:
// ordinary rods end before it. A strand's last change is taken as it is.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

inline constexpr float kLeastShare = 0.3f;

template <class G>
HWY_INLINE typename G::V relaxation(const G& g, const RodJob& job,
                                    hn::Mask<hn::DFromV<typename G::V>> goes_on) {
  using V = typename G::V;
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), zero = hn::Zero(d);
  const auto compares = hn::And(goes_on, hn::Ge(g.lane(kLaneIterations), hn::Set(d, 2)));
  if (hn::AllFalse(d, compares)) return one;
  V along = zero, square = zero;
  for (size_t i = 0; i < job.segments; ++i) {
    const Three<V> last = g.get3(i, kRodLastTurn), change = last - g.get3(i, kRodImpulse + 3);
    along = hn::Add(along, dot(last, change));
    square = hn::Add(square, dot(change, change));
  }
  const V secant = hn::Div(hn::Mul(g.lane(kLaneShare), along), hn::Max(square, hn::Set(d, 1e-30f)));
  const V share = hn::Min(hn::Max(secant, hn::Set(d, kLeastShare)), g.lane(kLaneLargestShare));
  return hn::IfThenElse(compares, share, one);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

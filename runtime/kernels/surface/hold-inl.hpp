// hold-inl.hpp  Columns of numbers brought to scale, held inside a bound each, and laid out as rows.
//
//   rows[i][j] = clamp(columns[j][i] scale[j], +-bound[j]), 0 where that is not finite;  how many it changed
//   columns [width][kBlock], of which `count` <= kBlock are rows   rows [count][width]
//   scale, bound [width]   width a multiple of kBlock; all 64-byte aligned
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Four columns from lane `first` on. `changed` counts lanes of `live`.
HWY_INLINE void hold_four(const HoldJob& job, size_t column, uint32_t first, hn::Mask<Floats> live,
                          Vector (&held)[4], Vector* changed) {
  const Floats d;
  SINEW_UNROLL
  for (size_t k = 0; k < 4; ++k) {
    const Vector value = hn::Load(d, job.columns + (column + k) * kBlock + first);
    const Vector x = hn::Mul(value, hn::Set(d, job.scale[column + k]));
    const Vector most = hn::Set(d, job.bound[column + k]);
    const Vector inside = hn::Min(hn::Max(x, hn::Neg(most)), most);
    const auto finite = hn::IsFinite(x);
    const auto other = hn::And(live, hn::Or(hn::Not(finite), hn::Ne(inside, x)));
    *changed = hn::Add(*changed, hn::IfThenElseZero(other, hn::Set(d, 1)));
    held[k] = hn::IfThenElseZero(finite, inside);
  }
}

uint32_t hold_columns(const HoldJob& job) {
  using Four = hn::CappedTag<float, 4>;
  constexpr size_t kStep = hn::MaxLanes(Four());
  const Floats d;
  Vector changed = hn::Zero(d);
  for (uint32_t first = 0; first < job.count; first += kLanes) {
    const uint32_t live = HWY_MIN(static_cast<uint32_t>(kLanes), job.count - first);
    for (size_t column = 0; column < job.width; column += 4) {
      Vector held[4];
      hold_four(job, column, first, hn::FirstN(d, live), held, &changed);
      HWY_ALIGN float fours[4 * kLanes];
      hn::StoreInterleaved4(held[0], held[1], held[2], held[3], d, fours);
      for (uint32_t i = 0; i < live; ++i) {
        float* row = job.rows + (first + i) * job.width + column;
        for (size_t k = 0; k < 4; k += kStep)
          hn::Store(hn::Load(Four(), fours + size_t{4} * i + k), Four(), row + k);
      }
    }
  }
  return static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(d, changed)));
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

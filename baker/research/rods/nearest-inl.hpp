// nearest-inl.hpp  A start by the nearest of kept examples, the mean of three (Shao et al. 2021, Sec. 4).
//
// Every segment is compared with every example: a baseline, not meant to be fast. Cost a segment and vector
// of strands: kRodStartInputs multiply-adds an example.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// The nearest so far, nearest first.
template <class V>
struct Nearest {
  V far[baker::kNeighbours], index[baker::kNeighbours];
};

// Ties keep the earlier example.
template <class V>
HWY_INLINE void offer(V far, V index, Nearest<V>* nearest) {
  auto closer = hn::Lt(far, nearest->far[0]);
  SINEW_UNROLL
  for (size_t k = 0; k < baker::kNeighbours; ++k) {
    closer = hn::Or(closer, hn::Lt(far, nearest->far[k]));  // what is moved down moves the next one down
    const V was = nearest->far[k], whose = nearest->index[k];
    nearest->far[k] = hn::IfThenElse(closer, far, was);
    nearest->index[k] = hn::IfThenElse(closer, index, whose);
    far = hn::IfThenElse(closer, was, far);
    index = hn::IfThenElse(closer, whose, index);
  }
}

template <size_t kWidth, class D>
HWY_INLINE Nearest<hn::Vec<D>> find_nearest(D d, const baker::ExampleRows& examples, const float* told) {
  using V = hn::Vec<D>;
  const V none = hn::Zero(d), most = hn::Set(d, 3e38f);
  Nearest<V> nearest = {{most, most, most}, {none, none, none}};
  for (uint32_t e = 0; e < examples.count; ++e) {
    const float* input = examples.inputs + size_t{e} * kRodStartInputs;
    V far = none;
    SINEW_UNROLL
    for (size_t k = 0; k < kRodStartInputs; ++k) {
      const V by = hn::Sub(hn::Load(d, told + k * kWidth), hn::Set(d, input[k]));
      far = hn::MulAdd(by, by, far);
    }
    offer(far, hn::Set(d, static_cast<float>(e)), &nearest);
  }
  return nearest;
}

// The mean answer of each lane's neighbours, [kRodStartNumbers][width].
template <size_t kWidth, class D>
HWY_INLINE void mean_answers(D d, const baker::ExampleRows& examples, const Nearest<hn::Vec<D>>& nearest,
                             float* out) {
  HWY_ALIGN float index[kWidth];
  for (size_t k = 0; k < kRodStartNumbers; ++k) hn::Store(hn::Zero(d), d, out + k * kWidth);
  for (size_t n = 0; n < baker::kNeighbours; ++n) {
    hn::Store(nearest.index[n], d, index);
    for (size_t lane = 0; lane < hn::MaxLanes(d); ++lane) {
      const float* answer = examples.answers + static_cast<size_t>(index[lane]) * kRodStartNumbers;
      for (size_t k = 0; k < kRodStartNumbers; ++k)
        out[k * kWidth + lane] += answer[k] * (1.0f / baker::kNeighbours);
    }
  }
}

template <size_t kWidth>
void rod_add_nearest(const RodJob& job, const RodStartJob& start, const baker::ExampleRows& examples) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    using V = hn::Vec<LanesOf<kWidth>>;
    const LanesOf<kWidth> d;
    const size_t lane = static_cast<size_t>(g.records - job.records);
    HWY_ALIGN float answer[kRodStartNumbers * kWidth];
    const auto meant = inputs_mean_something(g);
    for (size_t i = 0; i < job.segments; ++i) {
      const float* told = start.inputs + i * kRodStartInputs * kWidth + lane;
      mean_answers<kWidth>(d, examples, find_nearest<kWidth>(d, examples, told), answer);
      const SegmentAxes<V> axes = axes_of(g.get4(i, kRodTurn));
      const LaneRows<LanesOf<kWidth>, kWidth> rows = {answer, kRodStartNumbers};
      for (size_t part = 0; part < (i > 0 ? kRodStartNumbers : 6); part += 3) {
        correct<kWidth>(g, job, start, i, part, rows.get3(0, part), axes, meant);
      }
    }
  });
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

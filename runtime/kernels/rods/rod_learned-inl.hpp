// rod_learned-inl.hpp  A small COPINGNet on a group of strands, a strand a lane.
//
// The equations are rods/start/coping_net.hpp's. A layer multiplies its matrix by as many columns as a vector
// has lanes, kLaneColumns outputs at a time: a weight is read once for all strands, inputs come from the
// records as they lie there, a neighbour is the next row. Sums run over the inputs in their order. Cost a
// segment and vector of strands: a multiply-add a weight.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

inline constexpr size_t kLaneColumns = 8;

struct LanePart {
  const float* rows;  // [depth][width]
  uint32_t depth;
};
inline constexpr size_t kLaneParts = 3;
struct LaneInput {
  LanePart parts[kLaneParts];
  uint32_t count;
};

template <size_t kWidth, class D>
HWY_INLINE void dense_lanes(D d, const RodStartNet& net, const pack::DenseRecord& layer, const LaneInput& in,
                            bool bends, float* out) {
  using V = hn::Vec<D>;
  for (size_t j = 0; j < layer.outputs; j += kLaneColumns) {
    const float *w = net.weights + layer.w + j, *bias = net.weights + layer.bias + j;
    V sum[kLaneColumns];
    SINEW_UNROLL
    for (size_t c = 0; c < kLaneColumns; ++c) sum[c] = hn::Set(d, bias[c]);
    for (uint32_t part = 0; part < in.count; ++part) {
      for (uint32_t k = 0; k < in.parts[part].depth; ++k, w += layer.padded) {
        const V x = hn::Load(d, in.parts[part].rows + k * kWidth);
        SINEW_UNROLL
        for (size_t c = 0; c < kLaneColumns; ++c) sum[c] = hn::MulAdd(x, hn::Set(d, w[c]), sum[c]);
      }
    }
    const V zero = hn::Zero(d);
    SINEW_UNROLL
    for (size_t c = 0; c < kLaneColumns; ++c) {
      const V y = bends ? hn::IfThenElse(hn::Lt(sum[c], zero), zero, sum[c]) : sum[c];
      hn::Store(y, d, out + (j + c) * kWidth);
    }
  }
}

// Planes of one vector of lanes.
struct LaneNet {
  float *v, *e, *sum;       // [segments][latent][width]
  float *hidden[2], *last;  // [pack::kPanel][width]
};
template <size_t kWidth>
HWY_INLINE LaneNet lane_net(const RodJob& job, const RodStartNet& net, float* planes) {
  const size_t plane = size_t{job.segments} * net.latent * kWidth, row = size_t{pack::kPanel} * kWidth;
  float* rest = planes + 3 * plane;
  return {planes, planes + plane, planes + 2 * plane, {rest, rest + row}, rest + 2 * row};
}

template <size_t kWidth, class D>
HWY_INLINE void chain_lanes(D d, const RodStartNet& net, uint32_t chain, LaneInput in, const LaneNet& at,
                            float* out) {
  const pack::DenseRecord* layer = net.layers + size_t{chain} * (net.depth + 1);
  for (uint32_t k = 0; k < net.depth; ++k, ++layer) {
    dense_lanes<kWidth>(d, net, *layer, in, true, at.hidden[k % 2]);
    in = {{{at.hidden[k % 2], layer->outputs}}, 1};
  }
  dense_lanes<kWidth>(d, net, *layer, in, false, out);
}

template <size_t kWidth, class D>
HWY_INLINE void add_lanes(D d, const float* more, size_t count, float* sum) {
  for (size_t k = 0; k < count; ++k) {
    hn::Store(hn::Add(hn::Load(d, sum + k * kWidth), hn::Load(d, more + k * kWidth)), d, sum + k * kWidth);
  }
}
template <size_t kWidth, class D>
HWY_INLINE void copy_lanes(D d, const float* from, size_t count, float* to) {
  for (size_t k = 0; k < count; ++k) hn::Store(hn::Load(d, from + k * kWidth), d, to + k * kWidth);
}

template <size_t kWidth, class D>
HWY_INLINE void message_block(D d, const RodJob& job, const RodStartNet& net, uint32_t block,
                              const LaneNet& at) {
  const size_t row = size_t{net.latent} * kWidth;
  const uint32_t n = net.latent;
  for (size_t k = 0; k < n; ++k) hn::Store(hn::Zero(d), d, at.sum + k * kWidth);
  for (size_t i = 1; i < job.segments; ++i) {
    float* e = at.e + i * row;
    const LaneInput in = {{{e, n}, {at.v + job.parents[i] * row, n}, {at.v + i * row, n}}, 3};
    chain_lanes<kWidth>(d, net, 2 * block + 3, in, at, at.last);
    add_lanes<kWidth>(d, at.last, n, e);
    copy_lanes<kWidth>(d, e, n, at.sum + i * row);
  }
  for (size_t i = 1; i < job.segments; ++i)
    add_lanes<kWidth>(d, at.e + i * row, n, at.sum + job.parents[i] * row);
  for (size_t i = 0; i < job.segments; ++i) {
    float* v = at.v + i * row;
    chain_lanes<kWidth>(d, net, 2 * block + 2, {{{v, n}, {at.sum + i * row, n}}, 2}, at, at.last);
    add_lanes<kWidth>(d, at.last, n, v);
  }
}

// What a decoder makes of a row: two triples.
template <size_t kWidth, class D>
HWY_INLINE Six<hn::Vec<D>> decode_lanes(D d, const RodStartNet& net, uint32_t decoder, const float* row,
                                        const LaneNet& at) {
  using V = hn::Vec<D>;
  const uint32_t chains = 2 * (net.blocks + 2);
  const pack::DenseRecord& final_layer = net.layers[chains * (net.depth + 1) - 1];
  const float* norms = net.weights + final_layer.bias + final_layer.padded + decoder * 16;
  chain_lanes<kWidth>(d, net, chains - 2 + decoder, {{{row, net.latent}}, 1}, at, at.last);
  const auto value = [&](size_t k) HWY_ATTR {
    const V x = value_of(tanh_of(hn::Load(d, at.last + k * kWidth)));
    return hn::Mul(hn::Set(d, norms[k]), x);
  };
  return {{value(0), value(1), value(2)}, {value(3), value(4), value(5)}};
}

template <size_t kWidth>
void rod_add_network(const RodJob& job, const RodStartJob& start, const RodStartNet& net) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    using V = hn::Vec<LanesOf<kWidth>>;
    const LanesOf<kWidth> d;
    const size_t lane = static_cast<size_t>(g.records - job.records), row = size_t{net.latent} * kWidth;
    const LaneNet at = lane_net<kWidth>(job, net, start.planes + lane);
    for (size_t i = 0; i < job.segments; ++i) {
      const float* told = start.inputs + i * kRodStartInputs * kWidth + lane;
      chain_lanes<kWidth>(d, net, 0, {{{told, kRodStartInputs}}, 1}, at, at.v + i * row);
      if (i > 0) copy_lanes<kWidth>(d, start.encodings + i * row + lane, net.latent, at.e + i * row);
    }
    for (uint32_t block = 0; block < net.blocks; ++block) message_block<kWidth>(d, job, net, block, at);
    const auto meant = inputs_mean_something(g);
    for (size_t i = 0; i < job.segments; ++i) {
      const SegmentAxes<V> axes = axes_of(g.get4(i, kRodTurn));
      const Six<V> node = decode_lanes<kWidth>(d, net, 0, at.v + i * row, at);
      correct<kWidth>(g, job, start, i, 0, node.f, axes, meant);
      correct<kWidth>(g, job, start, i, 3, node.t, axes, meant);
      if (i == 0) continue;
      const Six<V> joint = decode_lanes<kWidth>(d, net, 1, at.e + i * row, at);
      correct<kWidth>(g, job, start, i, 6, joint.f, axes, meant);
      correct<kWidth>(g, job, start, i, 9, joint.t, axes, meant);
    }
  });
}

template <size_t kWidth>
void rod_encode_joints(const RodJob& job, const RodStartNet& net, const float* joints, float* encodings,
                       float* planes) {
  for_lanes<kWidth>(job, [&](const auto& g) HWY_ATTR {
    const LanesOf<kWidth> d;
    const size_t lane = static_cast<size_t>(g.records - job.records);
    const LaneNet at = lane_net<kWidth>(job, net, planes + lane);
    for (size_t i = 1; i < job.segments; ++i) {
      const float* told = joints + i * kRodJointInputs * kWidth + lane;
      chain_lanes<kWidth>(d, net, 1, {{{told, kRodJointInputs}}, 1}, at,
                          encodings + i * net.latent * kWidth + lane);
    }
  });
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

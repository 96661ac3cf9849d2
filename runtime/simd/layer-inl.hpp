// layer-inl.hpp  One Alt-ConvLSTM layer for a range of nodes in two passes.
//
//   a       = b + (P x) W_x + x W_s + (P h) W_h                        (arXiv 2006.07818 Eq. 5, 9)
//   i, f    = sigmoid(a_if + (P y) W_y_if)
//   c       = clamp(f c + i tanh(a_c))
//   o       = sigmoid(a_o + (P y_t) W_y_o);  h = o tanh(c)             second pass, for it needs all y_t
//   hidden layers (Eq. 11):   P y_t = y_keep P y + P c
//   last layer (Eq. 10):      y_t = y_keep y + y_gain c + carry
//
// y of a hidden layer is heard only through P, and P c is what the next layer's x becomes: so P y is kept
// instead of y, and its aggregation costs nothing.
//
// T is what h, c and y are kept as, float or Half; what is read from them is summed, multiplied and added as
// floats. Shapes: kernels.hpp, LayerJob. Nodes go by kRangeNodes. For each block of channels the weights of
// its gates (at most 100 KB in the paper's network) are read from L2 by one tile of kTileRows nodes after the
// other, and a tile's gates become cells while they are in L1. Between the passes a_o waits in output_gate.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct Range {
  uint32_t first, count;  // nodes, at most kRangeNodes
};

HWY_INLINE Range range_at(uint32_t first, uint32_t last) {
  return {first, HWY_MIN(kRangeNodes, last - first)};
}

// Rows of a plane, or of what was aggregated for a range.
struct Plane {
  const float* rows;
  size_t stride;
  TileRows tile(uint32_t first, uint32_t end) const {
    return {rows + first * stride, stride, HWY_MIN(kTileRows, end - first)};
  }
};

HWY_INLINE void copy_floats(const float* from, size_t count, float* out) {
  for (size_t j = 0; j < count; j += kLanes) hn::Store(hn::Load(Floats(), from + j), Floats(), out + j);
}

// P x of the range's nodes, in `out`.
template <class T>
HWY_INLINE Plane aggregated(const LayerJob& job, Range range, const T* x, float* out) {
  aggregate_rows(job.graph, x, job.padded, range.first, range.first + range.count, out);
  return {out, job.padded};
}

// The range's own rows as floats: where they lie, or in `out`.
template <class T>
HWY_INLINE Plane own_rows(Range range, const T* x, size_t stride, float* out) {
  return {floats_of(x + range.first * stride, range.count * stride, out), stride};
}

HWY_INLINE Plane own_x(const LayerJob& job, Range range, float* out) {
  if (!job.w_s) return {};
  return job.x_is_half ? own_rows(range, static_cast<const Half*>(job.x), job.x_stride, out)
                       : own_rows(range, static_cast<const float*>(job.x), job.x_stride, out);
}

// What the nodes of a range hear, row 0 the first node's.
struct Heard {
  Plane px, x, ph, py;
};

// a and the peepholes of gates i f c o, channels j .. j + kBlock - 1, of a tile, in gates
// [kTileRows][4][kBlock].
HWY_INLINE void sum_gates(const LayerJob& job, const Heard& heard, uint32_t tile, uint32_t end, size_t j,
                          float* gates) {
  const size_t p = job.padded, row = 4 * kBlock, inputs = job.inputs, channels = job.channels;
  Term terms[4];
  size_t count = 0;
  terms[count++] = {heard.px.tile(tile, end), inputs, job.w_x + 4 * j * inputs, row};
  if (job.w_s) terms[count++] = {heard.x.tile(tile, end), inputs, job.w_s + 4 * j * inputs, row};
  terms[count++] = {heard.ph.tile(tile, end), channels, job.w_h + 4 * j * channels, row};
  terms[count] = {heard.py.tile(tile, end), channels, job.w_y + 2 * j * channels, row / 2};
  if constexpr (kLanes == kBlock) {
    multiply<4, 2>({{job.bias + j, 0, 1}, terms, count, p, gates, row}, 0);
  } else {
    for (size_t at = 0; at < row; at += kWide * kLanes) {
      const size_t gate = at / kBlock;
      const TileRows bias = {job.bias + gate * p + j + at % kBlock, 0, 1};
      const Product product = {bias, terms, count, kLanes, gates + at, row};
      if (gate < 2) multiply<kWide, kWide>(product, at);
      if (gate >= 2) multiply<kWide, 0>(product, at);
    }
  }
}

// clamp(f c + i tanh(a_c)) with one division.
template <class Curve = FineTanh>
HWY_INLINE Vector next_cell(Vector a_i, Vector a_f, Vector a_c, Vector c, Vector bound) {
  const Quotient i = sigmoid_of<Curve>(a_i), f = sigmoid_of<Curve>(a_f);
  const Quotient added = product_of(i, tanh_of<Curve>(a_c));
  const Vector sum = hn::MulAdd(hn::Mul(f.over, c), added.under, hn::Mul(added.over, f.under));
  return bounded(hn::Div(sum, hn::Mul(f.under, added.under)), bound);
}

// gates [4][kBlock]; c and output_gate: a block of the node's.
template <class Curve = FineTanh, class T>
HWY_INLINE void update_cells(const float* gates, float bound, T* c, float* output_gate) {
  const Floats d;
  const auto gate = [&](size_t which, size_t j) HWY_ATTR { return hn::Load(d, gates + which * kBlock + j); };
  for (size_t j = 0; j < kBlock; j += kLanes) {
    store_state(next_cell<Curve>(gate(0, j), gate(1, j), gate(2, j), load_state(c + j), hn::Set(d, bound)),
                c + j);
    hn::Store(gate(3, j), d, output_gate + j);
  }
}

HWY_INLINE void update_output_state(const LayerJob& job, uint32_t node) {
  const Floats d;
  const size_t at = node * size_t{job.padded};
  const auto *y = static_cast<const float*>(job.y), *c = static_cast<const float*>(job.c);
  const Vector keep = hn::Set(d, job.y_keep), gain = hn::Set(d, job.y_gain);
  for (size_t j = at; j < at + job.padded; j += kLanes) {
    const Vector kept = hn::Mul(keep, hn::Load(d, y + j));
    hn::Store(hn::MulAdd(gain, hn::Load(d, c + j), kept), d, job.y_next + j);
  }
  if (job.carry) {
    for (size_t axis = 0; axis < 3; ++axis) job.y_next[at + axis] += job.carry[node * 3 + axis];
  }
}

template <class T>
HWY_INLINE void range_cells(const LayerJob& job, Range range, const float* px) {
  const size_t p = job.padded;
  T* c = static_cast<T*>(job.c);
  const auto *h = static_cast<const T*>(job.h), *y = static_cast<const T*>(job.y);
  float* rows = job.tile + kTileRows * 4 * kBlock;
  const Plane ph = aggregated(job, range, h, rows);
  float* more = rows + kRangeNodes * p;
  const Plane py = job.y_next ? aggregated(job, range, y, more) : own_rows(range, y, p, more);
  const Heard heard = {{px, job.x_stride}, own_x(job, range, more + kRangeNodes * p), ph, py};
  for (size_t j = 0; j < p; j += kBlock) {
    for (uint32_t tile = 0; tile < range.count; tile += kTileRows) {
      sum_gates(job, heard, tile, range.count, j, job.tile);
      for (uint32_t i = tile; i < HWY_MIN(tile + kTileRows, range.count); ++i) {
        const size_t at = (range.first + i) * p + j;
        update_cells(job.tile + (i - tile) * 4 * kBlock, job.clamp, c + at, job.output_gate + at);
      }
    }
  }
  for (uint32_t i = 0; job.y_next && i < range.count; ++i) update_output_state(job, range.first + i);
}

void layer_cells(const LayerJob& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes) {
    const float* px = job.px + (node - first) * job.x_stride;
    if (job.state_is_half) range_cells<Half>(job, range_at(node, last), px);
    if (!job.state_is_half) range_cells<float>(job, range_at(node, last), px);
  }
}

// P c of the range's nodes, in pc, and with it P y, which comes back as floats: where it lies, or in `out`.
template <class T>
HWY_INLINE Plane hear_cells(const LayerJob& job, Range range, float* pc, float* out) {
  const Floats d;
  const size_t p = job.padded, count = range.count * p;
  T* py = static_cast<T*>(job.y) + range.first * p;
  const Vector keep = hn::Set(d, job.y_keep);
  aggregated(job, range, static_cast<const T*>(job.c), pc);
  for (size_t j = 0; j < count; j += kLanes)
    store_state(hn::MulAdd(keep, load_state(py + j), hn::Load(d, pc + j)), py + j);
  return {floats_of(py, count, out), p};
}

template <class Curve = FineTanh>
HWY_INLINE Vector next_hidden(Vector a_o, Vector c) {
  return value_of(product_of(sigmoid_of<Curve>(a_o), tanh_of<Curve>(c)));
}

// h = o tanh(c) of `count` channels.
template <class T>
HWY_INLINE void update_hidden(const float* gate, const T* c, size_t count, T* h) {
  const Floats d;
  for (size_t j = 0; j < count; j += kLanes)
    store_state(next_hidden(hn::Load(d, gate + j), load_state(c + j)), h + j);
}

template <size_t kVectors, class T>
HWY_INLINE void output_columns(const LayerJob& job, Range range, const Plane& py, size_t j) {
  constexpr size_t kColumns = kVectors * kLanes;
  const size_t p = job.padded;
  const Plane waiting = {job.output_gate + range.first * p + j, p};
  const size_t panel = j / pack::kPanel * pack::kPanel, width = HWY_MIN(size_t{pack::kPanel}, p - panel);
  const float* w_o = job.w_y + (2 * p + panel) * job.channels + (j - panel);
  const T* c = static_cast<const T*>(job.c);
  T* h = static_cast<T*>(job.h);
  for (uint32_t tile = 0; tile < range.count; tile += kTileRows) {
    const Term term = {py.tile(tile, range.count), job.channels, w_o, width};
    multiply<kVectors, 0>({waiting.tile(tile, range.count), &term, 1, kLanes, job.tile, kColumns}, 0);
    for (uint32_t i = tile; i < HWY_MIN(tile + kTileRows, range.count); ++i) {
      const size_t at = (range.first + i) * p + j;
      update_hidden(job.tile + (i - tile) * kColumns, c + at, kColumns, h + at);
    }
  }
}

template <class T>
HWY_INLINE void range_output(const LayerJob& job, Range range, float* pc) {
  const size_t p = job.padded, at = range.first * p;
  float* rows = job.tile + kTileRows * 4 * kBlock;
  const Plane py =
      job.y_next ? aggregated(job, range, job.y_next, rows) : hear_cells<T>(job, range, pc, rows);
  const auto body = [&]<size_t kVectors>(size_t j)
                        HWY_ATTR { output_columns<kVectors, T>(job, range, py, j); };
  for_columns(p, body);
  if (job.y_next) copy_floats(job.y_next + at, range.count * p, static_cast<float*>(job.y) + at);
}

void layer_output(const LayerJob& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes) {
    float* pc = job.pc + (node - first) * job.padded;
    if (job.state_is_half) range_output<Half>(job, range_at(node, last), pc);
    if (!job.state_is_half) range_output<float>(job, range_at(node, last), pc);
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

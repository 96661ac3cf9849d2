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
// What is read of x, h, c and y is summed, multiplied and added as floats, whatever they are kept as
// (state-inl.hpp). Job: a LayerJobOf. Shapes: kernels.hpp, LayerJobOf. Nodes go by kRangeNodes. For each
// block of channels the weights of its gates (at most 100 KB in the paper's network) are read from L2 by one
// tile of kTileRows nodes after the other, and a tile's gates become cells while they are in L1. Between the
// passes a_o waits in output_gate.
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

template <class T>
HWY_INLINE void copy_floats(const float* from, size_t count, T* out) {
  for (size_t j = 0; j < count; j += kLanes) store_state(hn::Load(Floats(), from + j), out + j);
}

// P x of the range's nodes, in `out`.
template <class Job, class T>
HWY_INLINE Plane aggregated(const Job& job, Range range, const T* x, float* out) {
  aggregate_rows(job.graph, x, job.padded, range.first, range.first + range.count, out);
  return {out, job.padded};
}

// Asks for numbers of a row that are soon read or written: they come from the last cache, while sums go on.
template <class T>
HWY_INLINE void fetch_early(const T* row, size_t count) {
  for (size_t k = 0; k < count; k += 64 / sizeof(T)) __builtin_prefetch(row + k);
}

// P h of the range's nodes to use(node of the range, first column, sums); what their cells need is asked for.
template <class Job, class Use>
HWY_INLINE void hear_hidden(const Job& job, Range range, const Use& use) {
  const size_t p = job.padded;
  const auto *c = job.c, *y = job.y;
  const auto take = [&]<size_t kVectors>(uint32_t i, size_t j, const Vector(&sum)[kVectors]) HWY_ATTR {
    const size_t at = (range.first + i) * p + j, count = kVectors * kLanes;
    fetch_early(c + at, count);
    fetch_early(y + at, count);
    fetch_early(job.output_gate + at, count);
    use(i, j, sum);
  };
  aggregate_into(job.graph, job.h, p, range.first, range.first + range.count, take);
}

// The range's own rows as floats: where they lie, or in `out`.
template <class T>
HWY_INLINE Plane own_rows(Range range, const T* x, size_t stride, float* out) {
  return {floats_of(x + range.first * stride, range.count * stride, out), stride};
}

template <class Job>
HWY_INLINE Plane own_x(const Job& job, Range range, float* out) {
  return job.w_s ? own_rows(range, job.x, job.x_stride, out) : Plane{};
}

// What the nodes of a range hear, row 0 the first node's.
struct Heard {
  Plane px, x, ph, py;
};

// a and the peepholes of gates i f c o, channels j .. j + kBlock - 1, of a tile, in gates
// [kTileRows][4][kBlock].
template <class Job>
HWY_INLINE void sum_gates(const Job& job, const Heard& heard, uint32_t tile, uint32_t end, size_t j,
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

template <class Job>
HWY_INLINE void update_output_state(const Job& job, uint32_t node) {
  const Floats d;
  const size_t at = node * size_t{job.padded};
  const Vector keep = hn::Set(d, job.y_keep), gain = hn::Set(d, job.y_gain);
  for (size_t j = at; j < at + job.padded; j += kLanes) {
    const Vector kept = hn::Mul(keep, load_state(job.y + j));
    hn::Store(hn::MulAdd(gain, load_state(job.c + j), kept), d, job.y_next + j);
  }
  if (job.carry) {
    for (size_t axis = 0; axis < 3; ++axis) job.y_next[at + axis] += job.carry[node * 3 + axis];
  }
}

template <class Job>
HWY_INLINE void range_cells(const Job& job, Range range, const float* px) {
  const size_t p = job.padded;
  float* rows = job.tile + kTileRows * 4 * kBlock;
  const auto store = [&]<size_t kVectors>(uint32_t i, size_t j, const Vector(&sum)[kVectors])
                         HWY_ATTR { store_vectors(sum, rows + i * p + j); };
  hear_hidden(job, range, store);
  const Plane ph = {rows, p};
  float* more = rows + kRangeNodes * p;
  const Plane py = job.y_next ? aggregated(job, range, job.y, more) : own_rows(range, job.y, p, more);
  const Heard heard = {{px, job.x_stride}, own_x(job, range, more + kRangeNodes * p), ph, py};
  for (size_t j = 0; j < p; j += kBlock) {
    for (uint32_t tile = 0; tile < range.count; tile += kTileRows) {
      sum_gates(job, heard, tile, range.count, j, job.tile);
      for (uint32_t i = tile; i < HWY_MIN(tile + kTileRows, range.count); ++i) {
        const size_t at = (range.first + i) * p + j;
        update_cells(job.tile + (i - tile) * 4 * kBlock, job.clamp, job.c + at, job.output_gate + at);
      }
    }
  }
  for (uint32_t i = 0; job.y_next && i < range.count; ++i) update_output_state(job, range.first + i);
}

template <class Job>
void layer_cells(const Job& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes)
    range_cells(job, range_at(node, last), job.px + (node - first) * job.x_stride);
}

// P c of the range's nodes in pc, and with it P y, which also goes to use(node of the range, first column, P
// y).
template <class Job, class Use>
HWY_INLINE void hear_cells(const Job& job, Range range, float* pc, const Use& use) {
  const size_t p = job.padded, first = range.first * p;
  const Vector keep = hn::Set(Floats(), job.y_keep);
  auto *py = job.y + first, *h = job.h + first;
  const auto take = [&]<size_t kVectors>(uint32_t i, size_t j, const Vector(&sum)[kVectors]) HWY_ATTR {
    const size_t at = i * p + j, count = kVectors * kLanes;
    if (i + kTileRows < range.count) fetch_early(py + at + kTileRows * p, count);
    fetch_early(h + at, count);
    fetch_early(job.output_gate + first + at, count);
    store_vectors(sum, pc + at);
    Vector next[kVectors];
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) {
      next[v] = hn::MulAdd(keep, load_state(py + at + v * kLanes), sum[v]);
      store_state(next[v], py + at + v * kLanes);
    }
    use(i, j, next);
  };
  aggregate_into(job.graph, job.c, p, range.first, range.first + range.count, take);
}

// P y of t: of the last layer in `out`, of another as floats, where it lies or in `out`, and P c in pc.
template <class Job>
HWY_INLINE Plane peepholes(const Job& job, Range range, float* pc, float* out) {
  if (job.y_next) return aggregated(job, range, job.y_next, out);
  const auto nothing = []<size_t kVectors>(uint32_t, size_t, const Vector(&)[kVectors]) HWY_ATTR {};
  hear_cells(job, range, pc, nothing);
  return own_rows(range, job.y, job.padded, out);
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

template <size_t kVectors, class Job>
HWY_INLINE void output_columns(const Job& job, Range range, const Plane& py, size_t j) {
  constexpr size_t kColumns = kVectors * kLanes;
  const size_t p = job.padded;
  const Plane waiting = {job.output_gate + range.first * p + j, p};
  const size_t panel = j / pack::kPanel * pack::kPanel, width = HWY_MIN(size_t{pack::kPanel}, p - panel);
  const float* w_o = job.w_y + (2 * p + panel) * job.channels + (j - panel);
  for (uint32_t tile = 0; tile < range.count; tile += kTileRows) {
    const Term term = {py.tile(tile, range.count), job.channels, w_o, width};
    multiply<kVectors, 0>({waiting.tile(tile, range.count), &term, 1, kLanes, job.tile, kColumns}, 0);
    for (uint32_t i = tile; i < HWY_MIN(tile + kTileRows, range.count); ++i) {
      const size_t at = (range.first + i) * p + j;
      update_hidden(job.tile + (i - tile) * kColumns, job.c + at, kColumns, job.h + at);
    }
  }
}

template <class Job>
HWY_INLINE void range_output(const Job& job, Range range, float* pc) {
  const size_t p = job.padded, at = range.first * p;
  float* rows = job.tile + kTileRows * 4 * kBlock;
  const Plane py = peepholes(job, range, pc, rows);
  const auto body = [&]<size_t kVectors>(size_t j) HWY_ATTR { output_columns<kVectors>(job, range, py, j); };
  for_columns(p, body);
  if (job.y_next) copy_floats(job.y_next + at, range.count * p, job.y + at);
}

template <class Job>
void layer_output(const Job& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes)
    range_output(job, range_at(node, last), job.pc + (node - first) * job.padded);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

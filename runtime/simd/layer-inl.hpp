// layer-inl.hpp  One Alt-ConvLSTM layer for a range of nodes, kTileRows at a time, in two passes.
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
// Shapes: kernels.hpp, LayerJob. A tile's gates (kTileRows x 4 padded) and its aggregated rows stay in L1. A
// tile that is not full repeats its last node and stores it once. Between the passes a_o waits in
// output_gate.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct Tile {
  uint32_t first, count;  // nodes
  float* rows;            // [kTileRows][padded], aggregated
  float* more_rows;       // as many
  float* gates;           // [kTileRows][4 padded]
};

HWY_INLINE Tile tile_at(const LayerJob& job, uint32_t first, uint32_t last) {
  float* more = job.tile + kTileRows * job.padded;
  return {first, HWY_MIN(kTileRows, last - first), job.tile, more, more + kTileRows * job.padded};
}

// P x of the tile's nodes, in `out`.
HWY_INLINE RowPointers aggregated(const LayerJob& job, const Tile& tile, const float* x, float* out) {
  for (uint32_t r = 0; r < tile.count; ++r)
    aggregate_row(job.graph, tile.first + r, x, job.padded, out + r * job.padded);
  return rows_of(out, job.padded, tile.count);
}

// px: P x of the tile's nodes.
HWY_INLINE void sum_gates(const LayerJob& job, const Tile& tile, const float* px) {
  const size_t p = job.padded;
  Term terms[4];
  size_t count = 0;
  terms[count++] = {rows_of(px, job.x_stride, tile.count), job.inputs, job.w_x, 4 * p};
  if (job.w_s) {
    const float* x = job.x + tile.first * job.x_stride;
    terms[count++] = {rows_of(x, job.x_stride, tile.count), job.inputs, job.w_s, 4 * p};
  }
  terms[count++] = {aggregated(job, tile, job.h, tile.rows), job.channels, job.w_h, 4 * p};
  const RowPointers py = job.y_next ? aggregated(job, tile, job.y, tile.more_rows)
                                    : rows_of(job.y + tile.first * p, p, tile.count);
  terms[count] = {py, job.channels, job.w_y, 3 * p};
  const RowPointers bias = rows_of(job.bias, 0, tile.count);
  multiply({bias, terms, count + 1, tile.gates, 4 * p}, 0, 2 * p);
  multiply({bias, terms, count, tile.gates, 4 * p}, 2 * p, 4 * p);
}

HWY_INLINE void update_cells(const LayerJob& job, const float* gates, uint32_t node) {
  const Floats d;
  const size_t p = job.padded;
  const size_t at = node * p;
  const Vector clamp = hn::Set(d, job.clamp);
  for (size_t j = 0; j < p; j += kLanes) {
    const Vector i = sigmoid_of(hn::Load(d, gates + j));
    const Vector f = sigmoid_of(hn::Load(d, gates + p + j));
    const Vector g = tanh_of(hn::Load(d, gates + 2 * p + j));
    const Vector c = bounded(hn::MulAdd(f, hn::Load(d, job.c + at + j), hn::Mul(i, g)), clamp);
    hn::Store(c, d, job.c + at + j);
    hn::Store(hn::Load(d, gates + 3 * p + j), d, job.output_gate + at + j);
  }
}

HWY_INLINE void update_output_state(const LayerJob& job, uint32_t node) {
  const Floats d;
  const size_t at = node * size_t{job.padded};
  const Vector keep = hn::Set(d, job.y_keep), gain = hn::Set(d, job.y_gain);
  for (size_t j = at; j < at + job.padded; j += kLanes) {
    const Vector kept = hn::Mul(keep, hn::Load(d, job.y + j));
    hn::Store(hn::MulAdd(gain, hn::Load(d, job.c + j), kept), d, job.y_next + j);
  }
  if (job.carry) {
    for (size_t axis = 0; axis < 3; ++axis) job.y_next[at + axis] += job.carry[node * 3 + axis];
  }
}

void layer_cells(const LayerJob& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kTileRows) {
    const Tile tile = tile_at(job, node, last);
    sum_gates(job, tile, job.px + (node - first) * job.x_stride);
    for (uint32_t r = 0; r < tile.count; ++r) {
      update_cells(job, tile.gates + r * 4 * job.padded, node + r);
      if (job.y_next) update_output_state(job, node + r);
    }
  }
}

// P c of one node, in pc, and with it P y.
HWY_INLINE void hear_cells(const LayerJob& job, uint32_t node, float* pc) {
  const Floats d;
  float* py = job.y + node * size_t{job.padded};
  const Vector keep = hn::Set(d, job.y_keep);
  aggregate_row(job.graph, node, job.c, job.padded, pc);
  for (size_t j = 0; j < job.padded; j += kLanes)
    hn::Store(hn::MulAdd(keep, hn::Load(d, py + j), hn::Load(d, pc + j)), d, py + j);
}

HWY_INLINE void update_hidden(const LayerJob& job, const float* gate, uint32_t node) {
  const Floats d;
  const size_t at = node * size_t{job.padded};
  for (size_t j = 0; j < job.padded; j += kLanes) {
    const Vector o = sigmoid_of(hn::Load(d, gate + j));
    hn::Store(hn::Mul(o, tanh_of(hn::Load(d, job.c + at + j))), d, job.h + at + j);
    if (job.y_next) hn::Store(hn::Load(d, job.y_next + at + j), d, job.y + at + j);
  }
}

void layer_output(const LayerJob& job, uint32_t first, uint32_t last) {
  const size_t p = job.padded;
  for (uint32_t node = first; node < last; node += kTileRows) {
    const Tile tile = tile_at(job, node, last);
    RowPointers py = rows_of(job.y + node * p, p, tile.count);
    if (job.y_next) {
      py = aggregated(job, tile, job.y_next, tile.rows);
    } else {
      for (uint32_t r = 0; r < tile.count; ++r) hear_cells(job, node + r, job.pc + (node - first + r) * p);
    }
    const Term term = {py, job.channels, job.w_y + 2 * p, 3 * p};
    multiply({rows_of(job.output_gate + node * p, p, tile.count), &term, 1, tile.gates, p}, 0, p);
    for (uint32_t r = 0; r < tile.count; ++r) update_hidden(job, tile.gates + r * p, node + r);
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

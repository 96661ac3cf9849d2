// layer-inl.hpp  One Alt-ConvLSTM layer for a range of nodes, kTileRows at a time, in two passes.
//
//   a       = b + (P x) W_x + x W_s + (P h) W_h                        (arXiv 2006.07818 Eq. 5, 9)
//   i, f    = sigmoid(a_if + (P y) W_y_if)
//   c       = clamp(f c + i tanh(a_c))
//   y_next  = y_keep y + y_gain c + carry                              (Eq. 10, 11)
//   o       = sigmoid(a_o + (P y_next) W_y_o);  h = o tanh(c)          second pass, for it needs all y_next
//
// Shapes: kernels.hpp, LayerJob. A tile's sums (kTileRows x 4 padded) and its aggregated rows stay in L1; a
// tile that is not full computes rows of zeros and does not store them. Between the passes a_o waits in
// output_gate.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct Tile {
  uint32_t first, count;  // nodes
  float* rows;            // [kTileRows][stride of what is aggregated]
  float* gates;           // [kTileRows][4 padded]
};

HWY_INLINE Tile tile_at(const LayerJob& job, uint32_t first, uint32_t last) {
  const size_t widest = HWY_MAX(pad_to_block(job.inputs), static_cast<size_t>(job.padded));
  return {first, HWY_MIN(kTileRows, last - first), job.tile, job.tile + kTileRows * widest};
}

HWY_INLINE void zero_floats(float* out, size_t count) {
  for (size_t j = 0; j < count; j += kLanes) hn::Store(hn::Zero(Floats()), Floats(), out + j);
}

HWY_INLINE void copy_floats(const float* from, size_t count, float* out) {
  for (size_t j = 0; j < count; j += kLanes) hn::Store(hn::Load(Floats(), from + j), Floats(), out + j);
}

// tile.rows = P x of the tile's nodes; rows beyond them zero.
HWY_INLINE void aggregate_tile(const Tile& tile, const SparseRows& graph, const float* x, size_t stride) {
  for (uint32_t r = 0; r < tile.count; ++r) {
    aggregate_row(graph, tile.first + r, x, stride, tile.rows + r * stride);
  }
  zero_floats(tile.rows + tile.count * stride, (kTileRows - tile.count) * stride);
}

// tile.rows = x of the tile's nodes; rows beyond them zero.
HWY_INLINE void copy_tile(const Tile& tile, const float* x, size_t stride) {
  copy_floats(x + tile.first * stride, tile.count * stride, tile.rows);
  zero_floats(tile.rows + tile.count * stride, (kTileRows - tile.count) * stride);
}

HWY_INLINE void sum_gates(const LayerJob& job, const Tile& tile) {
  const size_t p = job.padded, all = 4 * p;
  for (uint32_t r = 0; r < kTileRows; ++r) copy_floats(job.bias, all, tile.gates + r * all);
  aggregate_tile(tile, job.graph, job.x, job.x_stride);
  add_product({tile.rows, job.x_stride, job.inputs, job.w_x, all, tile.gates, all}, all);
  if (job.w_s) {
    copy_tile(tile, job.x, job.x_stride);
    add_product({tile.rows, job.x_stride, job.inputs, job.w_s, all, tile.gates, all}, all);
  }
  aggregate_tile(tile, job.graph, job.h, p);
  add_product({tile.rows, p, job.channels, job.w_h, all, tile.gates, all}, all);
  aggregate_tile(tile, job.graph, job.y, p);
  add_product({tile.rows, p, job.channels, job.w_y, 3 * p, tile.gates, all}, 2 * p);
}

HWY_INLINE void update_cells(const LayerJob& job, const float* gates, uint32_t node) {
  const Floats d;
  const size_t p = job.padded;
  const size_t at = node * p;
  const Vector clamp = hn::Set(d, job.clamp), keep = hn::Set(d, job.y_keep), gain = hn::Set(d, job.y_gain);
  for (size_t j = 0; j < p; j += kLanes) {
    const Vector i = sigmoid_of(hn::Load(d, gates + j));
    const Vector f = sigmoid_of(hn::Load(d, gates + p + j));
    const Vector g = tanh_of(hn::Load(d, gates + 2 * p + j));
    const Vector c = bounded(hn::MulAdd(f, hn::Load(d, job.c + at + j), hn::Mul(i, g)), clamp);
    const Vector y = hn::MulAdd(gain, c, hn::Mul(keep, hn::Load(d, job.y + at + j)));
    hn::Store(c, d, job.c + at + j);
    hn::Store(y, d, job.y_next + at + j);
    hn::Store(hn::Load(d, gates + 3 * p + j), d, job.output_gate + at + j);
  }
  if (job.carry) {
    for (size_t axis = 0; axis < 3; ++axis) job.y_next[at + axis] += job.carry[node * 3 + axis];
  }
}

void layer_cells(const LayerJob& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kTileRows) {
    const Tile tile = tile_at(job, node, last);
    sum_gates(job, tile);
    for (uint32_t r = 0; r < tile.count; ++r) update_cells(job, tile.gates + r * 4 * job.padded, node + r);
  }
}

HWY_INLINE void update_output(const LayerJob& job, const float* gate, uint32_t node) {
  const Floats d;
  const size_t at = node * static_cast<size_t>(job.padded);
  for (size_t j = 0; j < job.padded; j += kLanes) {
    const Vector o = sigmoid_of(hn::Load(d, gate + j));
    hn::Store(hn::Mul(o, tanh_of(hn::Load(d, job.c + at + j))), d, job.h + at + j);
    hn::Store(hn::Load(d, job.y_next + at + j), d, job.y + at + j);
  }
}

void layer_output(const LayerJob& job, uint32_t first, uint32_t last) {
  const size_t p = job.padded;
  for (uint32_t node = first; node < last; node += kTileRows) {
    const Tile tile = tile_at(job, node, last);
    copy_floats(job.output_gate + node * p, tile.count * p, tile.gates);
    zero_floats(tile.gates + tile.count * p, (kTileRows - tile.count) * p);
    aggregate_tile(tile, job.graph, job.y_next, p);
    add_product({tile.rows, p, job.channels, job.w_y + 2 * p, 3 * p, tile.gates, p}, p);
    for (uint32_t r = 0; r < tile.count; ++r) update_output(job, tile.gates + r * p, node + r);
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

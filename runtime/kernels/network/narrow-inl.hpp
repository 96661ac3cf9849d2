// narrow-inl.hpp  An Alt-ConvLSTM layer of at most eight channels, its gates side by side in one vector.
//
// The equations and their order are layer-inl.hpp's, and so are the bits; what differs is what is left out. A
// plane's rows are padded to kBlock, of which a layer of 8 channels fills half and one of 3 a fifth. Here a
// gate takes `width` floats, 4 or 8, of weights packed anew (LayerJob::packed), so that a node's four gates
// are 16 or 32 floats, and the cells of two or four nodes share a vector. W_y has a row for each gate, zero
// for c and o: what that adds is zero. P h, and P y of the last layer, come in one sweep over the graph for
// all layers (aggregate_planes), since a sweep of few columns waits for its branches, not for its sums.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// ---- aggregation ----

template <size_t kPlanes>
HWY_INLINE void aggregate_group(const SparseRows& graph, const float* const* planes, uint32_t first,
                                uint32_t last, float* const* out) {
  const Floats d;
  constexpr size_t kVectors = kBlock / kLanes;
  uint32_t e = graph.rows[first];
  for (uint32_t node = first; node < last; ++node) {
    Vector sum[kPlanes * kVectors];
    SINEW_UNROLL
    for (size_t v = 0; v < kPlanes * kVectors; ++v) sum[v] = hn::Zero(d);
    for (const uint32_t end = graph.rows[node + 1]; e < end; ++e) {
      const Vector value = hn::Set(d, graph.values[e]);
      const size_t at = graph.columns[e] * size_t{kBlock};
      SINEW_UNROLL
      for (size_t v = 0; v < kPlanes * kVectors; ++v) {
        const float* row = planes[v / kVectors] + at + v % kVectors * kLanes;
        sum[v] = hn::MulAdd(value, hn::Load(d, row), sum[v]);
      }
    }
    SINEW_UNROLL
    for (size_t v = 0; v < kPlanes * kVectors; ++v) {
      float* row = out[v / kVectors] + node * size_t{kBlock};
      hn::Store(sum[v], d, row + v % kVectors * kLanes);
    }
  }
}

void aggregate_planes(const SparseRows& graph, const float* const* planes, uint32_t count, uint32_t first,
                      uint32_t last, float* const* out) {
  constexpr uint32_t kAtOnce = HWY_MAX(1, HWY_MIN(size_t{4}, 2 * kWide * kLanes / kBlock));
  for (; count >= kAtOnce; count -= kAtOnce, planes += kAtOnce, out += kAtOnce)
    aggregate_group<kAtOnce>(graph, planes, first, last, out);
  for (; count > 0; --count) aggregate_group<1>(graph, planes++, first, last, out++);
}

// ---- rows of `width` floats, several to a vector ----

// `width` floats of as many rows as fill a vector, from row i on; the last row is repeated.
template <size_t kWidth, class D>
HWY_INLINE hn::Vec<D> load_rows(D d, const TileRows& rows, size_t i) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) > kWidth) {
    const hn::Half<D> half;
    constexpr size_t kRows = hn::MaxLanes(hn::Half<D>()) / kWidth;
    return hn::Combine(d, load_rows<kWidth>(half, rows, i + kRows), load_rows<kWidth>(half, rows, i));
  }
#endif
  return hn::Load(d, rows.row(i));
}

// The same back; a repeated row holds the same numbers.
template <size_t kWidth, class D>
HWY_INLINE void store_rows(D d, hn::Vec<D> v, const TileRows& rows, size_t i) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) > kWidth) {
    const hn::Half<D> half;
    constexpr size_t kRows = hn::MaxLanes(hn::Half<D>()) / kWidth;
    store_rows<kWidth>(half, hn::UpperHalf(half, v), rows, i + kRows);
    store_rows<kWidth>(half, hn::LowerHalf(half, v), rows, i);
    return;
  }
#endif
  hn::Store(v, d, const_cast<float*>(rows.row(i)));
}

// Runs body(first row, column) so that each number of `count` rows of kWidth is in one vector.
template <size_t kWidth, class Body>
HWY_INLINE void for_row_vectors(uint32_t count, const Body& body) {
  constexpr size_t kRows = HWY_MAX(size_t{1}, kLanes / kWidth);
  for (size_t i = 0; i < count; i += kRows) {
    for (size_t j = 0; j < kWidth; j += kLanes) body(i, j);
  }
}

// ---- first pass ----

// a and the peepholes of i and f, of a range, in gates [nodes][4][width].
template <size_t kWidth>
HWY_INLINE void narrow_gates(const LayerJob& job, const Heard& heard, uint32_t count, float* gates) {
  constexpr size_t kRow = 4 * kWidth;
  const float* w = job.packed;
  const auto next = [&w](size_t depth) { return std::exchange(w, w + depth * kRow); };
  const float* bias = next(1);
  const float *w_x = next(job.inputs), *w_s = next(job.w_s ? job.inputs : 0), *w_h = next(job.channels);
  for (uint32_t tile = 0; tile < count; tile += kTileRows) {
    Term terms[4];
    size_t terms_used = 0;
    terms[terms_used++] = {heard.px.tile(tile, count), job.inputs, w_x, kRow};
    if (job.w_s) terms[terms_used++] = {heard.x.tile(tile, count), job.inputs, w_s, kRow};
    terms[terms_used++] = {heard.ph.tile(tile, count), job.channels, w_h, kRow};
    terms[terms_used++] = {heard.py.tile(tile, count), job.channels, w, kRow};
    const auto body = [&]<size_t kVectors>(size_t j) HWY_ATTR {
      multiply<kVectors, 0>({{bias + j, 0, 1}, terms, terms_used, kLanes, gates + tile * kRow + j, kRow}, j);
    };
    for_columns(kRow, body);
  }
}

template <size_t kWidth>
HWY_INLINE void narrow_cell_states(const LayerJob& job, Range range, const float* gates) {
  const Floats d;
  const size_t at = range.first * size_t{kBlock};
  const TileRows gate = {gates, 4 * kWidth, range.count}, cells = {job.c + at, kBlock, range.count};
  const auto gate_at = [&](size_t which, size_t i, size_t j) HWY_ATTR {
    return load_rows<kWidth>(d, {gate.first + which * kWidth + j, gate.stride, gate.count}, i);
  };
  for_row_vectors<kWidth>(range.count, [&](size_t i, size_t j) HWY_ATTR {
    const TileRows c = {cells.first + j, cells.stride, cells.count};
    const Vector next = next_cell(gate_at(0, i, j), gate_at(1, i, j), gate_at(2, i, j),
                                  load_rows<kWidth>(d, c, i), hn::Set(d, job.clamp));
    store_rows<kWidth>(d, next, c, i);
  });
  for (uint32_t i = 0; i < range.count; ++i) {
    float* out = job.output_gate + at + i * kBlock;
    std::memcpy(out, gates + (4 * i + 3) * kWidth, kWidth * sizeof(float));
    std::memset(out + kWidth, 0, (kBlock - kWidth) * sizeof(float));
  }
}

template <size_t kWidth>
HWY_INLINE void narrow_range_cells(const LayerJob& job, Range range, const float* px) {
  const size_t at = range.first * size_t{kBlock};
  const Plane py = {(job.py ? job.py : job.y) + at, kBlock};
  const Plane x = own_x(job, range, job.tile + kRangeNodes * 4 * kWidth);
  narrow_gates<kWidth>(job, {{px, job.x_stride}, x, {job.ph + at, kBlock}, py}, range.count, job.tile);
  narrow_cell_states<kWidth>(job, range, job.tile);
  for (uint32_t i = 0; job.y_next && i < range.count; ++i) update_output_state(job, range.first + i);
}

void narrow_cells(const LayerJob& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes) {
    const float* px = job.px + (node - first) * job.x_stride;
    const Range range = range_at(node, last);
    job.gate_width == 4 ? narrow_range_cells<4>(job, range, px) : narrow_range_cells<8>(job, range, px);
  }
}

// ---- second pass ----

// o of a tile's nodes in job.tile, [kTileRows][kBlock]; then h.
template <size_t kWidth>
HWY_INLINE void narrow_tile_output(const LayerJob& job, Range range, const Plane& py, uint32_t tile) {
  const Floats d;
  const size_t at = range.first * size_t{kBlock};
  const Plane waiting = {job.output_gate + at, kBlock};
  const Plane cells = {job.c + at, kBlock};
  const Plane hidden = {job.h + at, kBlock};
  const Term term = {py.tile(tile, range.count), job.channels, job.w_y + 2 * kBlock * job.channels, kBlock};
  const auto body = [&]<size_t kVectors>(size_t j) HWY_ATTR {
    const Plane from = {waiting.rows + j, kBlock};
    multiply<kVectors, 0>({from.tile(tile, range.count), &term, 1, kLanes, job.tile + j, kBlock}, j);
  };
  for_columns(kBlock, body);
  const TileRows c = cells.tile(tile, range.count), h = hidden.tile(tile, range.count);
  for_row_vectors<kWidth>(c.count, [&](size_t i, size_t j) HWY_ATTR {
    const Vector gate = load_rows<kWidth>(d, {job.tile + j, kBlock, c.count}, i);
    const Vector cell = load_rows<kWidth>(d, {c.first + j, kBlock, c.count}, i);
    store_rows<kWidth>(d, next_hidden(gate, cell), {h.first + j, kBlock, h.count}, i);
  });
}

template <size_t kWidth>
HWY_INLINE void narrow_range_output(const LayerJob& job, Range range, float* pc) {
  const size_t at = range.first * size_t{kBlock};
  float* rows = job.tile + kTileRows * 4 * kBlock;
  const Plane py = peepholes(job, range, pc, rows);
  for (uint32_t tile = 0; tile < range.count; tile += kTileRows)
    narrow_tile_output<kWidth>(job, range, py, tile);
  if (job.y_next) copy_floats(job.y_next + at, range.count * size_t{kBlock}, job.y + at);
}

void narrow_output(const LayerJob& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes) {
    float* pc = job.pc + (node - first) * size_t{kBlock};
    const Range range = range_at(node, last);
    job.gate_width == 4 ? narrow_range_output<4>(job, range, pc) : narrow_range_output<8>(job, range, pc);
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

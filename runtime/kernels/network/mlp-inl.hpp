// mlp-inl.hpp  Rows through a chain of dense layers with a pointwise function between them.
//
//   z_1 = f(start + p_1 W_1[..] + p_2 W_1[..] + p_3 W_1[..])    the parts of a row, one after the other
//   z_k = f(z_{k-1} W_k + b_k)                                  f = tanh, or max(0, x); a NaN stays
//   out = g(z_{n-1} W_n + b_n) scale  (+ out)
//
// Rows go by kRangeNodes through the whole chain, so that what is hidden, 2 kRangeNodes x the widest layer
// (72 KB for 192), stays in L1 and L2. A layer's weights lie in panels of pack::kPanel columns, each read
// (48 KB for 192 inputs) for one tile of kTileRows rows after the other. Parts are read
// where they lie, through an index where there is one: nothing is gathered. Cost: the products', one pass
// over each tile's block while it is in L1.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

HWY_INLINE TileRows tile_of(const RowPart& part, size_t column, uint32_t row, uint32_t count) {
  const float* first = part.rows + column;
  if (part.index) return {first, part.stride, count, part.index + row};
  return {first + row * part.stride, part.stride, count};
}

template <Pointwise kFunction>
HWY_INLINE Vector pointwise(Vector x) {
  const Vector zero = hn::Zero(Floats());
  if constexpr (kFunction == Pointwise::kTanh) return value_of(tanh_of(x));
  if constexpr (kFunction == Pointwise::kRelu) return hn::IfThenElse(hn::Lt(x, zero), zero, x);
  return x;
}

// Of a tile [kTileRows][stride], `columns` of each row.
template <Pointwise kFunction>
HWY_INLINE void apply(float* tile, size_t stride, size_t columns) {
  const Floats d;
  for (size_t r = 0; r < kTileRows; ++r, tile += stride) {
    for (size_t j = 0; j < columns; j += kLanes)
      hn::Store(pointwise<kFunction>(hn::Load(d, tile + j)), d, tile + j);
  }
}

HWY_INLINE void apply(Pointwise function, float* tile, size_t stride, size_t columns) {
  if (function == Pointwise::kTanh) apply<Pointwise::kTanh>(tile, stride, columns);
  if (function == Pointwise::kRelu) apply<Pointwise::kRelu>(tile, stride, columns);
}

// One layer of a range of rows. `out` is a plane [kRangeNodes][padded], or null: the job's own out.
struct DenseStep {
  const pack::DenseRecord& layer;
  const RowPart* parts;
  uint32_t part_count, first_input;
  RowPart start;
  Pointwise function;
  uint32_t part_row;  // the range's first row in the parts
  Range range;        // in the job
  float* out;
};

HWY_INLINE void put_row(const MlpJob& job, const float* values, size_t column, size_t columns, float* out) {
  const Floats d;
  for (size_t j = 0; j < columns; j += kLanes) {
    Vector v = hn::Load(d, values + j);
    if (job.scale) v = hn::Mul(v, hn::Load(d, job.scale + column + j));
    if (job.adds) v = hn::Add(hn::Load(d, out + column + j), v);
    hn::Store(v, d, out + column + j);
  }
}

// The job's first scratch, [kTileRows][columns], to the rows of its out.
HWY_INLINE void put_tile(const MlpJob& job, Range range, uint32_t tile, size_t column, size_t columns) {
  for (uint32_t i = tile; i < HWY_MIN(tile + kTileRows, range.count); ++i) {
    const size_t row = job.out_index ? job.out_index[range.first + i] : range.first + i;
    put_row(job, job.scratch + (i - tile) * columns, column, columns, job.out + row * job.out_stride);
  }
}

// Columns panel + j .. of all tiles.
template <size_t kVectors>
HWY_INLINE void dense_columns(const MlpJob& job, const DenseStep& step, size_t panel, size_t j) {
  constexpr size_t kColumns = kVectors * kLanes;
  const size_t padded = step.layer.padded, width = HWY_MIN(size_t{pack::kPanel}, padded - panel),
               at = panel + j;
  const float* panel_w = job.weights + step.layer.w + panel * step.layer.inputs + step.first_input * width;
  for (uint32_t tile = 0; tile < step.range.count; tile += kTileRows) {
    const uint32_t row = step.part_row + tile, count = HWY_MIN(kTileRows, step.range.count - tile);
    Term terms[kMlpParts];
    const float* w = panel_w;
    for (uint32_t t = 0; t < step.part_count; ++t) {
      const uint32_t depth = step.parts[t].depth;
      terms[t] = {tile_of(step.parts[t], 0, row, count), depth, w, width};
      w += depth * width;
    }
    const TileRows start = tile_of(step.start, at, row, count);
    float* out = step.out ? step.out + tile * padded + at : job.scratch;
    const size_t stride = step.out ? padded : kColumns;
    multiply<kVectors, 0>({start, terms, step.part_count, kLanes, out, stride}, j);
    apply(step.function, out, stride, kColumns);
    if (!step.out) put_tile(job, step.range, tile, at, kColumns);
  }
}

HWY_INLINE void dense_layer(const MlpJob& job, const DenseStep& step) {
  for (size_t panel = 0; panel < step.layer.padded; panel += pack::kPanel) {
    const auto body = [&]<size_t kVectors>(size_t j)
                          HWY_ATTR { dense_columns<kVectors>(job, step, panel, j); };
    for_columns(HWY_MIN(size_t{pack::kPanel}, step.layer.padded - panel), body);
  }
}

// All layers for one range. Hidden layers go from one plane to the other and back.
HWY_INLINE void mlp_range(const MlpJob& job, Range range) {
  float* from = job.scratch + kTileRows * pack::kPanel;
  float* to = from + kRangeNodes * size_t{job.widest};
  RowPart hidden;
  for (uint32_t k = 0; k < job.layer_count; ++k) {
    const pack::DenseRecord& layer = job.layers[k];
    const bool is_first = k == 0, is_last = k + 1 == job.layer_count;
    const RowPart bias = {job.weights + layer.bias};
    dense_layer(job, {.layer = layer,
                      .parts = is_first ? job.parts : &hidden,
                      .part_count = is_first ? job.part_count : 1,
                      .first_input = is_first ? job.first_input : 0,
                      .start = is_first && job.start.rows ? job.start : bias,
                      .function = is_last ? job.last : job.between,
                      .part_row = is_first ? range.first : 0,
                      .range = range,
                      .out = is_last ? nullptr : to});
    hidden = {to, layer.padded, layer.outputs};
    std::swap(from, to);
  }
}

void mlp(const MlpJob& job, uint32_t first, uint32_t last) {
  for (uint32_t row = first; row < last; row += kRangeNodes) mlp_range(job, range_at(row, last));
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

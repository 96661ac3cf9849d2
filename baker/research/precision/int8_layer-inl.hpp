// int8_layer-inl.hpp  The two passes of kernels/network/layer-inl.hpp with products of bytes; states are
// halves.
//
//   gate = start + scale (sum_k q_k w_k),  q = round(per_unit heard) within +-127, ties to even
//   start = b, in the input layer b + (P x) W_x + x W_s in floats
//
// What a node hears is aggregated in floats, quantised, and multiplied in 32-bit integers, one sum a gate
// through all that is heard: the integers, and so the bits, are the same on every target. A node that hears
// what is not finite gets NaN for its cells, as in floats. Weights lie in the order that they are read, a
// block of channels after the other (Int8Job::int8): 20 KB, in L1 for a range's tiles.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

using baker::Int8Job;

// For int8 layers: degree 2 and |x| <= 5.02, from the iteration of FineTanh (kernels/tanh-inl.hpp) on the
// absolute error, which is 4.4e-5 for tanh and 2.2e-5 for sigmoid: a fifth of what a cell above 1/2 may lose
// as it is rounded to a half. Never beyond 1 - 4.3e-5; exact at 0; NaN stays NaN. Cost: 4 FMA fewer.
struct CoarseTanh {
  static constexpr float kBound = 5.02f;
  static constexpr float kP[] = {9.99805987e-1f, 1.01655945e-1f, 6.52992633e-4f};
  static constexpr float kQ[] = {1.0f, 4.34426397e-1f, 1.26192803e-2f};
};

// What a range hears in quantised rows, filled from left to right, kVectors vectors at a time.
template <class Dot>
struct QuantizedRows {
  typename Dot::Stored* rows;
  size_t stride, filled = 0;
  const float* per_unit;
  bool finite[kRangeNodes];

  template <size_t kVectors>
  HWY_INLINE void put(uint32_t i, size_t column, const Vector (&values)[kVectors]) {
    const Floats d;
    const float middle = kWhole + Dot::kOffset;
    Vector zeros = hn::Zero(d);
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) {
      const size_t at = filled + column + v * kLanes;
      const Vector q = hn::MulAdd(values[v], hn::Load(d, per_unit + at), hn::Set(d, middle));
      Dot::store(hn::Max(hn::Set(d, middle - 127), hn::Min(hn::Set(d, middle + 127), q)),
                 rows + i * stride + at);
      zeros = hn::MulAdd(values[v], hn::Zero(d), zeros);
    }
    finite[i] = finite[i] && hn::AllTrue(d, hn::Eq(zeros, hn::Zero(d)));
  }

  template <class T>
  HWY_INLINE void append(const T* x, size_t x_stride, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i, x += x_stride) {
      for_columns(x_stride, [&]<size_t kVectors>(size_t j) HWY_ATTR {
        Vector values[kVectors];
        SINEW_UNROLL
        for (size_t v = 0; v < kVectors; ++v) values[v] = load_state(x + j + v * kLanes);
        put(i, j, values);
      });
    }
    filled += x_stride;
  }
};

// Behind the tile's gates.
template <class Dot, class Job>
HWY_INLINE QuantizedRows<Dot> quantized_rows(const Job& job, size_t stride, const float* per_unit) {
  float* rows = job.tile + kTileRows * 4 * kBlock;
  QuantizedRows<Dot> heard = {.rows = reinterpret_cast<typename Dot::Stored*>(rows),
                              .stride = stride,
                              .per_unit = per_unit,
                              .finite = {}};
  for (bool& finite : heard.finite) finite = true;
  return heard;
}

// Groups of four rows of a matrix of bytes, `step` bytes apart.
struct ByteRows {
  const int8_t* w;
  size_t groups, step;
};

// The columns of one call are kVectors vectors, side by side in w, sums and scale, start_step floats apart in
// start. What `more` adds goes to the first kMore.
template <class Dot>
struct ByteProduct {
  const typename Dot::Stored* rows;
  size_t stride;
  uint32_t count;
  ByteRows all, more;
  const int32_t* sums;
  const float* scale;
  TileRows start;
  size_t start_step;
};

// `x`: the first number of each row; `offset`: how far into the rows the matrix begins.
template <class Dot, size_t kUsed, size_t kVectors>
HWY_INLINE void add_bytes(const ByteRows& matrix, const typename Dot::Stored* const (&x)[kTileRows],
                          size_t offset, IntVector (&sum)[kTileRows][kVectors]) {
  const int8_t* HWY_RESTRICT w = matrix.w;
  const size_t end = offset + 4 * matrix.groups, step = matrix.step;
  for (size_t k = offset; k < end; k += 4, w += step) {
    typename Dot::Weights weights[kUsed];
    SINEW_UNROLL
    for (size_t v = 0; v < kUsed; ++v) weights[v] = Dot::weights(w + v * 4 * kLanes);
    SINEW_UNROLL
    for (size_t r = 0; r < kTileRows; ++r) {
      SINEW_UNROLL
      for (size_t v = 0; v < kUsed; ++v) sum[r][v] = Dot::add(x[r] + k, weights[v], sum[r][v]);
    }
  }
}

// Each row's sums go to finish(row, sums).
template <class Dot, size_t kVectors, size_t kMore, class Finish>
HWY_NOINLINE void multiply_bytes(const ByteProduct<Dot>& job, const Finish& finish) {
  const Floats d;
  const Ints di;
  IntVector sum[kTileRows][kVectors];
  SINEW_UNROLL
  for (size_t v = 0; v < kVectors; ++v) {
    const IntVector from = Dot::kOffset != 0 ? hn::Neg(hn::Load(di, job.sums + v * kLanes)) : hn::Zero(di);
    SINEW_UNROLL
    for (size_t r = 0; r < kTileRows; ++r) sum[r][v] = from;
  }
  const typename Dot::Stored* x[kTileRows] = {job.rows};
  SINEW_UNROLL
  for (size_t r = 1; r < kTileRows; ++r) x[r] = r < job.count ? x[r - 1] + job.stride : x[r - 1];
  add_bytes<Dot, kVectors>(job.all, x, 0, sum);
  if constexpr (kMore > 0) add_bytes<Dot, kMore>(job.more, x, 4 * job.all.groups, sum);
  const size_t start_step = job.start_step, start_stride = job.start.count > 1 ? job.start.stride : 0;
  const float* start = job.start.first;
  const float* scale = job.scale;
  const size_t count = job.count;
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    if (r >= count) return;
    Vector gate[kVectors];
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) {
      const Vector from = hn::Load(d, start + v * start_step);
      gate[v] = hn::MulAdd(hn::ConvertTo(d, sum[r][v]), hn::Load(d, scale + v * kLanes), from);
    }
    finish(r, gate);
    start += start_stride;
  }
}

// Where the four gates of a block of a tile's channels start from, the first row's first gate first.
struct GateStart {
  TileRows rows;
  size_t step;  // from gate to gate
};

// b, and in the input layer, where `floats` has rows, what x adds to it, which is left in job.tile.
template <class Job>
HWY_INLINE GateStart start_gates(const Job& job, const Heard& floats, uint32_t tile, uint32_t end, size_t j) {
  const size_t p = job.padded, block = 4 * j * job.inputs, row = 4 * kBlock;
  if (!floats.px.rows) return {{job.bias + j, 0, 1}, p};
  Term terms[2] = {{floats.px.tile(tile, end), job.inputs, job.w_x + block, row}};
  if (job.w_s) terms[1] = {floats.x.tile(tile, end), job.inputs, job.w_s + block, row};
  for (size_t at = 0; at < row; at += kWide * kLanes) {
    const TileRows bias = {job.bias + at / kBlock * p + j + at % kBlock, 0, 1};
    const size_t step = kLanes == kBlock ? p : kLanes;
    multiply<kWide, 0>({bias, terms, job.w_s ? size_t{2} : size_t{1}, step, job.tile + at, row}, at);
  }
  return {{job.tile, row, kTileRows}, kBlock};
}

// Columns from `at` on of those gates.
template <class Dot, class Job>
HWY_INLINE ByteProduct<Dot> gate_product(const Job& job, const QuantizedRows<Dot>& heard,
                                         const GateStart& start, uint32_t tile, uint32_t end, size_t j,
                                         size_t at) {
  const size_t p = job.padded, depth = heard.filled - p;
  const int8_t* w = job.int8.w + j * (4 * depth + 2 * p);
  const float* first = start.rows.first + at / kBlock * start.step + at % kBlock;
  return {.rows = heard.rows + tile * heard.stride,
          .stride = heard.stride,
          .count = HWY_MIN(kTileRows, end - tile),
          .all = {w + at * 4, depth / 4, 16 * kBlock},
          .more = {w + depth * 4 * kBlock + at * 4, p / 4, 8 * kBlock},
          .sums = job.int8.sums + 4 * j + at,
          .scale = job.int8.scale + 4 * j + at,
          .start = {first, start.rows.stride, start.rows.count},
          .start_step = kLanes == kBlock ? start.step : kLanes};
}

// Cells and output gates of a block of a tile's channels: from registers where they hold all four gates.
template <class Dot, class Job>
HWY_INLINE void tile_byte_cells(const Job& job, Range range, const Heard& floats,
                                const QuantizedRows<Dot>& heard, uint32_t tile, size_t j) {
  constexpr size_t kVectors = Dot::kVectors, kRow = 4 * kBlock;
  const size_t p = job.padded, first = (range.first + tile) * p + j;
  Half* c = job.c + first;
  float* output_gate = job.output_gate + first;
  const GateStart start = start_gates(job, floats, tile, range.count, j);
  if constexpr (kVectors * kLanes == kRow) {
    const auto finish = [&](size_t r, const Vector(&gates)[kVectors]) HWY_ATTR {
      const Vector bound = hn::Set(Floats(), job.clamp), old = load_state(c + r * p);
      store_state(next_cell<CoarseTanh>(gates[0], gates[1], gates[2], old, bound), c + r * p);
      hn::Store(gates[3], Floats(), output_gate + r * p);
    };
    multiply_bytes<Dot, kVectors, kVectors / 2>(gate_product(job, heard, start, tile, range.count, j, 0),
                                                finish);
  } else {
    for (size_t at = 0; at < kRow; at += kVectors * kLanes) {
      const ByteProduct<Dot> product = gate_product(job, heard, start, tile, range.count, j, at);
      const auto finish = [&](size_t r, const Vector(&gates)[kVectors])
                              HWY_ATTR { store_vectors(gates, job.tile + r * kRow + at); };
      if (at < kRow / 2) multiply_bytes<Dot, kVectors, kVectors>(product, finish);
      if (at >= kRow / 2) multiply_bytes<Dot, kVectors, 0>(product, finish);
    }
    for (uint32_t r = 0; r < HWY_MIN(kTileRows, range.count - tile); ++r)
      update_cells<CoarseTanh>(job.tile + r * kRow, job.clamp, c + r * p, output_gate + r * p);
  }
}

// Rows of what is not finite become NaN.
template <class Dot>
HWY_INLINE void spread_nan(const QuantizedRows<Dot>& heard, uint32_t count, size_t padded, Half* rows) {
  for (uint32_t i = 0; i < count; ++i, rows += padded) {
    if (heard.finite[i]) continue;
    const Vector nan = hn::Set(Floats(), std::numeric_limits<float>::quiet_NaN());
    for (size_t j = 0; j < padded; j += kLanes) store_state(nan, rows + j);
  }
}

template <class Dot, class X>
HWY_INLINE void range_byte_cells(const Int8Job<X>& job, Range range, const float* px) {
  const size_t p = job.padded, first = range.first;
  auto heard = quantized_rows<Dot>(job, job.int8.depth, job.int8.per_unit);
  Heard floats = {};
  if constexpr (std::is_same_v<X, Half>) {
    heard.append(px, job.x_stride, range.count);
    if (job.w_s) heard.append(job.x + first * job.x_stride, job.x_stride, range.count);
  } else {
    floats.px = {px, job.x_stride};
    floats.x = own_x(job, range, nullptr);
  }
  const auto put = [&]<size_t kVectors>(uint32_t i, size_t j, const Vector(&sum)[kVectors])
                       HWY_ATTR { heard.put(i, j, sum); };
  hear_hidden(job, range, put);
  heard.filled += p;
  heard.append(job.y + first * p, p, range.count);
  for (size_t j = 0; j < p; j += kBlock) {
    for (uint32_t tile = 0; tile < range.count; tile += kTileRows)
      tile_byte_cells(job, range, floats, heard, tile, j);
  }
  spread_nan(heard, range.count, p, job.c + first * p);
}

template <class Dot, size_t kVectors, class Job>
HWY_INLINE void output_byte_columns(const Job& job, Range range, const QuantizedRows<Dot>& py, size_t j) {
  const size_t p = job.padded;
  const Plane waiting = {job.output_gate + range.first * p + j, p};
  for (uint32_t tile = 0; tile < range.count; tile += kTileRows) {
    const size_t first = (range.first + tile) * p + j;
    const Half* c = job.c + first;
    Half* h = job.h + first;
    const ByteProduct<Dot> product = {.rows = py.rows + tile * py.stride,
                                      .stride = py.stride,
                                      .count = HWY_MIN(kTileRows, range.count - tile),
                                      .all = {job.int8.w_o + 4 * j, p / 4, 4 * p},
                                      .more = {},
                                      .sums = job.int8.sums + 4 * p + j,
                                      .scale = job.int8.scale + 4 * p + j,
                                      .start = waiting.tile(tile, range.count),
                                      .start_step = kLanes};
    const auto finish = [&](size_t r, const Vector(&gates)[kVectors]) HWY_ATTR {
      SINEW_UNROLL
      for (size_t v = 0; v < kVectors; ++v) {
        const size_t at = r * p + v * kLanes;
        store_state(next_hidden<CoarseTanh>(gates[v], load_state(c + at)), h + at);
      }
    };
    multiply_bytes<Dot, kVectors, 0>(product, finish);
  }
}

template <class Dot, class Job>
HWY_INLINE void range_byte_output(const Job& job, Range range, float* pc) {
  const size_t p = job.padded;
  auto heard = quantized_rows<Dot>(job, p, job.int8.per_unit + job.int8.depth - p);
  const auto put = [&]<size_t kVectors>(uint32_t i, size_t j, const Vector(&py)[kVectors])
                       HWY_ATTR { heard.put(i, j, py); };
  hear_cells(job, range, pc, put);
  const auto body = [&]<size_t kVectors>(size_t j)
                        HWY_ATTR { output_byte_columns<Dot, kVectors>(job, range, heard, j); };
  for_columns(p, body);
  spread_nan(heard, range.count, p, job.h + range.first * p);
}

template <class Dot, class X>
void byte_layer_cells(const Int8Job<X>& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes)
    range_byte_cells<Dot>(job, range_at(node, last), job.px + (node - first) * job.x_stride);
}

template <class Dot, class X>
void byte_layer_output(const Int8Job<X>& job, uint32_t first, uint32_t last) {
  for (uint32_t node = first; node < last; node += kRangeNodes)
    range_byte_output<Dot>(job, range_at(node, last), job.pc + (node - first) * job.padded);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// int8_layer-inl.hpp  layer-inl.hpp's two passes with products of bytes; states are halves.
//
//   gate = start + scale (sum_k q_k w_k),  q = round(per_unit heard) within +-127, ties to even
//   start = b, in the input layer b + (P x) W_x + x W_s in floats
//
// What a node hears is aggregated in floats, quantised, and multiplied in 32-bit integers, one sum a gate
// through all that is heard: the integers, and so the bits, are the same on every target. A node that hears
// what is not finite gets NaN for its cells, as in floats. Weights lie in the order that they are read, a
// block of channels after the other (LayerJob::int8): 20 KB, in L1 for a range's tiles.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// One row quantised; false if it holds what is not finite.
template <class Dot, class T>
HWY_INLINE bool quantize_row(const T* x, size_t count, const float* per_unit, typename Dot::Stored* out) {
  const Floats d;
  const Vector zero = hn::Zero(d), largest = hn::Set(d, 127.0f);
  Vector zeros = zero;
  for (size_t j = 0; j < count; j += kLanes) {
    const Vector value = load_state(x + j);
    zeros = hn::MulAdd(value, zero, zeros);
    Dot::store(hn::NearestInt(bounded(hn::Mul(value, hn::Load(d, per_unit + j)), largest)), out + j);
  }
  return hn::AllTrue(d, hn::Eq(zeros, zero));
}

// The quantised rows of a range, filled from left to right.
template <class Dot>
struct QuantizedRows {
  typename Dot::Stored* rows;
  size_t stride, filled = 0;
  const float* per_unit;
  bool finite[kRangeNodes];

  template <class T>
  HWY_INLINE void append(const T* x, size_t x_stride, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
      const bool good =
          quantize_row<Dot>(x + i * x_stride, x_stride, per_unit + filled, rows + i * stride + filled);
      finite[i] = good && (filled == 0 || finite[i]);
    }
    filled += x_stride;
  }
};

// Groups of four rows of a matrix of bytes, `step` bytes apart.
struct ByteRows {
  const int8_t* w;
  size_t groups, step;
};

// The columns of one call are kVectors vectors, side by side in w, sums, scale and out, start_step floats
// apart in start. What `more` adds goes to the first kMore.
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
  float* out;  // [kTileRows][out_stride]
  size_t out_stride;
};

template <class Dot, size_t kUsed, size_t kVectors>
HWY_INLINE void add_bytes(const ByteRows& matrix, const typename Dot::Stored* (&x)[kTileRows],
                          IntVector (&sum)[kTileRows][kVectors]) {
  const int8_t* HWY_RESTRICT w = matrix.w;
  for (size_t group = 0; group < matrix.groups; ++group, w += matrix.step) {
    typename Dot::Weights weights[kUsed];
    SINEW_UNROLL
    for (size_t v = 0; v < kUsed; ++v) weights[v] = Dot::weights(w + v * 4 * kLanes);
    SINEW_UNROLL
    for (size_t r = 0; r < kTileRows; ++r) {
      SINEW_UNROLL
      for (size_t v = 0; v < kUsed; ++v) sum[r][v] = Dot::add(x[r] + 4 * group, weights[v], sum[r][v]);
    }
  }
  for (size_t r = 0; r < kTileRows; ++r) x[r] += 4 * matrix.groups;
}

template <class Dot, size_t kVectors, size_t kMore>
HWY_NOINLINE void multiply_bytes(const ByteProduct<Dot>& job) {
  const Floats d;
  const Ints di;
  IntVector sum[kTileRows][kVectors];
  SINEW_UNROLL
  for (size_t v = 0; v < kVectors; ++v) {
    const IntVector from = Dot::kOffset != 0 ? hn::Neg(hn::Load(di, job.sums + v * kLanes)) : hn::Zero(di);
    SINEW_UNROLL
    for (size_t r = 0; r < kTileRows; ++r) sum[r][v] = from;
  }
  const typename Dot::Stored* x[kTileRows];
  for (size_t r = 0; r < kTileRows; ++r) x[r] = job.rows + HWY_MIN(r, job.count - size_t{1}) * job.stride;
  add_bytes<Dot, kVectors>(job.all, x, sum);
  if constexpr (kMore > 0) add_bytes<Dot, kMore>(job.more, x, sum);
  SINEW_UNROLL
  for (size_t r = 0; r < kTileRows; ++r) {
    SINEW_UNROLL
    for (size_t v = 0; v < kVectors; ++v) {
      const Vector start = hn::Load(d, job.start.row(r) + v * job.start_step);
      const Vector scale = hn::Load(d, job.scale + v * kLanes);
      hn::Store(hn::MulAdd(hn::ConvertTo(d, sum[r][v]), scale, start), d,
                job.out + r * job.out_stride + v * kLanes);
    }
  }
}

template <class Dot>
HWY_INLINE QuantizedRows<Dot> quantized_rows(float* at, size_t stride, const float* per_unit) {
  return {.rows = reinterpret_cast<typename Dot::Stored*>(at),
          .stride = stride,
          .per_unit = per_unit,
          .finite = {}};
}

// Gates i f c o of a block of a tile's channels, in job.tile; `heard` floats are null but in the input layer.
template <class Dot>
HWY_INLINE void sum_byte_gates(const LayerJob& job, const Heard& floats, const QuantizedRows<Dot>& heard,
                               uint32_t tile, uint32_t end, size_t j) {
  const size_t p = job.padded, depth = heard.filled - p;
  TileRows start = {job.bias + j, 0, 1};
  size_t start_step = p;
  if (floats.px.rows) {
    const size_t block = 4 * j * job.inputs, row = 4 * kBlock;
    const Term terms[] = {
        {floats.px.tile(tile, end), job.inputs, job.w_x + block, row},
        {job.w_s ? floats.x.tile(tile, end) : TileRows{}, job.inputs, job.w_s + (job.w_s ? block : 0), row}};
    const size_t count = job.w_s ? 2 : 1;
    for (size_t at = 0; at < 4 * kBlock; at += kWide * kLanes) {
      constexpr bool kGateAVector = kLanes == kBlock;
      const TileRows bias = {job.bias + at / kBlock * p + j + at % kBlock, 0, 1};
      multiply<kWide, 0>({bias, terms, count, kGateAVector ? p : kLanes, job.tile + at, row}, at);
    }
    start = {job.tile, 4 * kBlock, kTileRows};
    start_step = kBlock;
  }
  constexpr size_t kVectors = Dot::kVectors;
  const int8_t* w = job.int8.w + j * (4 * depth + 2 * p);
  for (size_t at = 0; at < 4 * kBlock; at += kVectors * kLanes) {
    const size_t gate = at / kBlock, within = at % kBlock;
    const TileRows from = {start.first + gate * start_step + within, start.stride, start.count};
    const ByteProduct<Dot> product = {.rows = heard.rows + tile * heard.stride,
                                      .stride = heard.stride,
                                      .count = HWY_MIN(kTileRows, end - tile),
                                      .all = {w + at * 4, depth / 4, 16 * kBlock},
                                      .more = {w + depth * 4 * kBlock + at * 4, p / 4, 8 * kBlock},
                                      .sums = job.int8.sums + 4 * j + at,
                                      .scale = job.int8.scale + 4 * j + at,
                                      .start = from,
                                      .start_step = kLanes == kBlock ? start_step : kLanes,
                                      .out = job.tile + at,
                                      .out_stride = 4 * kBlock};
    if constexpr (kVectors * kLanes == 4 * kBlock) {
      multiply_bytes<Dot, kVectors, kVectors / 2>(product);
    } else {
      if (gate < 2) multiply_bytes<Dot, kVectors, kVectors>(product);
      if (gate >= 2) multiply_bytes<Dot, kVectors, 0>(product);
    }
  }
}

HWY_INLINE void fill_halves(Half* row, size_t count, float value) {
  for (size_t j = 0; j < count; j += kLanes) store_state(hn::Set(Floats(), value), row + j);
}

// Where a range's quantised rows lie behind its rows of floats.
HWY_INLINE float* behind_rows(const LayerJob& job) {
  return job.tile + kTileRows * 4 * kBlock + kRangeNodes * size_t{job.padded};
}

template <class Dot>
HWY_INLINE void range_byte_cells(const LayerJob& job, Range range, const float* px) {
  const size_t p = job.padded, first = range.first;
  Half *c = static_cast<Half*>(job.c), *y = static_cast<Half*>(job.y);
  float* rows = job.tile + kTileRows * 4 * kBlock;
  auto heard = quantized_rows<Dot>(behind_rows(job), job.int8.depth, job.int8.per_unit);
  Heard floats = {};
  if (job.int8.hears_x) {
    heard.append(px, job.x_stride, range.count);
    if (job.w_s)
      heard.append(static_cast<const Half*>(job.x) + first * job.x_stride, job.x_stride, range.count);
  } else {
    floats.px = {px, job.x_stride};
    floats.x = own_x(job, range, nullptr);
  }
  heard.append(aggregated(job, range, static_cast<const Half*>(job.h), rows).rows, p, range.count);
  heard.append(y + first * p, p, range.count);
  for (size_t j = 0; j < p; j += kBlock) {
    for (uint32_t tile = 0; tile < range.count; tile += kTileRows) {
      sum_byte_gates(job, floats, heard, tile, range.count, j);
      for (uint32_t i = tile; i < HWY_MIN(tile + kTileRows, range.count); ++i) {
        const size_t at = (first + i) * p + j;
        update_cells(job.tile + (i - tile) * 4 * kBlock, job.clamp, c + at, job.output_gate + at);
      }
    }
  }
  for (uint32_t i = 0; i < range.count; ++i) {
    if (!heard.finite[i]) fill_halves(c + (first + i) * p, p, std::numeric_limits<float>::quiet_NaN());
  }
}

template <class Dot, size_t kVectors>
HWY_INLINE void output_byte_columns(const LayerJob& job, Range range, const QuantizedRows<Dot>& py,
                                    size_t j) {
  constexpr size_t kColumns = kVectors * kLanes;
  const size_t p = job.padded;
  const Plane waiting = {job.output_gate + range.first * p + j, p};
  const Half* c = static_cast<const Half*>(job.c);
  Half* h = static_cast<Half*>(job.h);
  for (uint32_t tile = 0; tile < range.count; tile += kTileRows) {
    multiply_bytes<Dot, kVectors, 0>({.rows = py.rows + tile * py.stride,
                                      .stride = py.stride,
                                      .count = HWY_MIN(kTileRows, range.count - tile),
                                      .all = {job.int8.w_o + 4 * j, p / 4, 4 * p},
                                      .more = {},
                                      .sums = job.int8.sums + 4 * p + j,
                                      .scale = job.int8.scale + 4 * p + j,
                                      .start = waiting.tile(tile, range.count),
                                      .start_step = kLanes,
                                      .out = job.tile,
                                      .out_stride = kColumns});
    for (uint32_t i = tile; i < HWY_MIN(tile + kTileRows, range.count); ++i) {
      const size_t at = (range.first + i) * p + j;
      update_hidden(job.tile + (i - tile) * kColumns, c + at, kColumns, h + at);
    }
  }
}

template <class Dot>
HWY_INLINE void range_byte_output(const LayerJob& job, Range range, float* pc) {
  const size_t p = job.padded;
  const Plane py = hear_cells<Half>(job, range, pc, job.tile + kTileRows * 4 * kBlock);
  auto heard = quantized_rows<Dot>(behind_rows(job), p, job.int8.per_unit + job.int8.depth - p);
  heard.append(py.rows, p, range.count);
  const auto body = [&]<size_t kVectors>(size_t j)
                        HWY_ATTR { output_byte_columns<Dot, kVectors>(job, range, heard, j); };
  for_columns(p, body);
  for (uint32_t i = 0; i < range.count; ++i) {
    if (!heard.finite[i])
      fill_halves(static_cast<Half*>(job.h) + (range.first + i) * p, p,
                  std::numeric_limits<float>::quiet_NaN());
  }
}

template <class Dot>
void any_layer_cells(const LayerJob& job, uint32_t first, uint32_t last) {
  if (!job.int8.w) return layer_cells(job, first, last);
  for (uint32_t node = first; node < last; node += kRangeNodes)
    range_byte_cells<Dot>(job, range_at(node, last), job.px + (node - first) * job.x_stride);
}

template <class Dot>
void any_layer_output(const LayerJob& job, uint32_t first, uint32_t last) {
  if (!job.int8.w) return layer_output(job, first, last);
  for (uint32_t node = first; node < last; node += kRangeNodes)
    range_byte_output<Dot>(job, range_at(node, last), job.pc + (node - first) * job.padded);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// kernels.hpp  The vector kernels: one table of functions an instruction set, chosen once (kernels/isa.hpp).
//
// Each kernel is written once over Highway's vectors. Every sum runs in one fixed order, lane by lane, with
// fused multiply-adds, so that targets with FMA (avx3, avx2, neon) give the same bits whatever their vector
// width; the others differ by rounding only. Kernels allocate nothing. Pointers marked [padded] are 64-byte
// aligned, with rows of whole 16-float blocks; padding holds finite numbers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/rod_contacts/rod_force_job.hpp"
#include "kernels/rod_contacts/rod_touch_job.hpp"
#include "kernels/rods/rod_job.hpp"
#include "pack/format.hpp"
#include "sinew/export.h"

namespace sinew::simd {

inline constexpr uint32_t kBlock = 16;       // floats a row is padded to: the widest vector
inline constexpr uint32_t kTileRows = 6;     // nodes whose gates are worked on at a time
inline constexpr uint32_t kRangeNodes = 48;  // nodes that a layer's weights are read for at a time
inline constexpr uint32_t kInfluences = 8;

constexpr size_t pad_to_block(size_t count) { return (count + kBlock - 1) / kBlock * kBlock; }

// A sparse matrix P in CSR; square.
struct SparseRows {
  const uint32_t* rows;  // [nodes + 1]
  const uint32_t* columns;
  const float* values;
};

// One layer of an Alt-ConvLSTM at one step; equations in pack/format.hpp, NetworkRecord. A layer with y_next
// is the last one. Plane: [nodes][padded]. X is what x is kept as, T what h, c and y are; the arithmetic is
// float whatever they are, and so are they in the runtime (another form: baker/research/precision).
template <class X, class T>
struct LayerJobOf {
  SparseRows graph{};
  uint32_t inputs = 0, channels = 0, padded = 0;  // F_in, F, F rounded up to kBlock
  const float* w_x = nullptr;                     // [padded / 16][inputs][4][16]
  const float* w_s = nullptr;                     // the same or null
  const float* w_h = nullptr;                     // [padded / 16][channels][4][16]
  const float* w_y = nullptr;                     // pack/weight_layout.hpp, peephole_at
  const float* bias = nullptr;                    // [4][padded]
  const X* x = nullptr;                           // [nodes][x_stride] padded; read with w_s only
  size_t x_stride = 0;
  const float* px = nullptr;  // [last - first][x_stride], P x of the nodes of one call of layer_cells
  float* pc = nullptr;        // [last - first][padded], where a hidden layer_output leaves P c: the next px
  T* h = nullptr;             // plane, of t-1; layer_output makes it t
  T* c = nullptr;             // plane, of t-1; layer_cells makes it t
  T* y = nullptr;             // plane, of t-1; layer_output makes it t. In a hidden layer P y
  const float* carry = nullptr;  // [nodes][3] added to the last layer's y, or null
  float y_keep = 1, y_gain = 1;  // y = y_keep y + y_gain c + carry; a hidden layer's gain is 1
  float clamp = 0;               // bound on |c|; infinity: none
  float* y_next = nullptr;       // last layer: plane, scratch between the two calls
  float* output_gate = nullptr;  // plane, scratch between the two calls
  float* tile = nullptr;         // tile_floats(padded), scratch of one call
  // Of narrow_cells and narrow_output only, where padded is kBlock.
  uint32_t gate_width = 0;        // floats a gate takes in `packed`: 4 or 8, at least `channels`
  const float* packed = nullptr;  // rows [4][gate_width]: bias, W_x, W_s if there, W_h, W_y; zero for c and o
  const float* ph = nullptr;      // plane, P h of t-1
  const float* py = nullptr;      // last layer: plane, P y of t-1
};

using LayerJob = LayerJobOf<float, float>;

// Floats of LayerJob::tile.
size_t tile_floats(uint32_t padded) noexcept;

// `depth` numbers of rows of a plane: of row index[i], or of row i where there is no index. Any alignment.
struct RowPart {
  const float* rows = nullptr;
  size_t stride = 0;
  uint32_t depth = 0;
  const uint32_t* index = nullptr;
};

enum class Pointwise : uint32_t { kNone, kRelu, kTanh };

inline constexpr uint32_t kMlpParts = 3;

// Rows through a chain of dense layers (pack/format.hpp, DenseRecord):
//   z = between(z W + b), layer after layer, and of the last: out = last(z W + b) scale
// A row's first z is its parts, one after the other, met by the first layer's inputs from first_input on.
struct MlpJob {
  const pack::DenseRecord* layers = nullptr;  // [layer_count], at least one
  const float* weights = nullptr;             // what the layers' offsets count from
  uint32_t layer_count = 0;
  uint32_t widest = 0;  // of the layers' padded
  RowPart parts[kMlpParts]{};
  uint32_t part_count = 0, first_input = 0;
  RowPart start{};  // [padded] rows that take the place of the first layer's bias; null: the bias
  Pointwise between = Pointwise::kNone, last = Pointwise::kNone;
  const float* scale = nullptr;  // [padded] of the last layer, or null: 1
  bool adds = false;             // out is added to; it may be a part too, read without an index and without
                                 // out_index, where there are two layers or more
  float* out = nullptr;          // [rows][out_stride] [padded]
  size_t out_stride = 0;
  const uint32_t* out_index = nullptr;  // the row of out that row i is for, or null: i
  float* scratch = nullptr;             // mlp_floats(widest) [padded]
};

// Floats of MlpJob::scratch.
size_t mlp_floats(uint32_t widest) noexcept;

// Points moved by up to eight joints each: out = sum_i weight[i] matrices[joint[i]] (point, 1).
// Strides in bytes.
struct SkinJob {
  const float* points;  // x y z at each stride
  size_t point_stride;
  const uint16_t* joints;  // kInfluences at each stride
  const float* weights;    // kInfluences at each stride, descending: a zero ends the list
  size_t skin_stride;
  const float* matrices;  // [joints][12], row-major 3x4: posed x inverse bind
  float* out;             // x y z at each stride
  size_t out_stride;
  uint32_t count;
};

// Frames that follow three quarters of their turn against `held`; cosines of half a turn below which the rest
// fades out, and is nothing (tissue/frames/node_bend.hpp).
inline constexpr float kBendFading = 0.4f, kBendGone = 0.1f;
struct BendJob {
  float held[9];     // row-major rotation
  float* rotations;  // row-major, at each stride; become three quarters
  float* bends;      // rotation vector of the quarter that is left, at each stride
  size_t stride;     // floats
  uint32_t count;
};

// Columns of up to kBlock rows; all [padded].
struct HoldJob {
  const float* columns;        // [width][kBlock]
  const float *scale, *bound;  // [width]
  float* rows;                 // [count][width]
  size_t width;                // a multiple of kBlock
  uint32_t count;              // 0..kBlock
};

// Vectors turned by rotation vectors of up to two radians. in and out [count][3], may be the same.
struct TurnJob {
  const float* turns;  // three numbers at each stride
  size_t turn_stride;  // floats
  const float* in;
  float* out;
  uint32_t count;
};

struct SurfaceWalks;  // kernels/surface/surface_walk.hpp

struct Kernels {
  int64_t target;  // Highway's bit
  bool fused;      // has FMA: belongs to the targets that give the same bits

  // out[i - first] = sum_e values[e] x[columns[e]], rows of `stride` floats [padded], nodes first..last.
  void (*aggregate)(const SparseRows& graph, const float* x, size_t stride, uint32_t first, uint32_t last,
                    float* out);
  // Gates i f c, then c (last layer: and y_next), of nodes first..last; needs h and the last layer's y of t-1
  // of all nodes.
  void (*layer_cells)(const LayerJob& job, uint32_t first, uint32_t last);
  // Gate o, then h and y, of nodes first..last; needs c (last layer: y_next) of t of all nodes.
  void (*layer_output)(const LayerJob& job, uint32_t first, uint32_t last);
  // out[p][i] = sum_e values[e] planes[p][columns[e]], rows of kBlock floats [padded], nodes i first..last.
  void (*aggregate_planes)(const SparseRows& graph, const float* const* planes, uint32_t count,
                           uint32_t first, uint32_t last, float* const* out);
  // As layer_cells and layer_output, the same bits, for a layer of at most eight channels.
  void (*narrow_cells)(const LayerJob& job, uint32_t first, uint32_t last);
  void (*narrow_output)(const LayerJob& job, uint32_t first, uint32_t last);
  // Rows first .. last, one after the other in out.
  void (*mlp)(const MlpJob& job, uint32_t first, uint32_t last);
  // out[axis][v] = sum_n weights[n][v] displacement[n][axis]; weights [nodes][stride], out [3][stride]
  // [padded]; v < stride, a multiple of kBlock. Reads each weight once; out is overwritten.
  void (*carry)(const float* weights, uint32_t nodes, size_t stride, const float* displacement, float* out);
  // out[i] = sum_k weights[k] rows[k][i], i < stride; rows and out [padded].
  void (*add_rows)(const float* rows, uint32_t count, size_t stride, const float* weights, float* out);
  void (*skin)(const SkinJob& job);
  // rows[i][j] = clamp(columns[j][i] scale[j], +-bound[j]), 0 where that is not finite. Returns how many it
  // changed beyond the scale.
  uint32_t (*hold_columns)(const HoldJob& job);
  void (*share_bend)(const BendJob& job);
  void (*turn)(const TurnJob& job);       // by exp([turn]x)
  void (*turn_back)(const TurnJob& job);  // by exp([turn]x)^T
  void (*warp)(const TurnJob& job);       // by the mean of exp([x turn]x), x from 0 to 1
  // Places, then row-major turns, of frames: 3 and 9 floats at each out_stride. root: row-major rotation.
  void (*pose_frames)(const SkinJob& job, const float* root);
  // Of `count` floats, any count and alignment; NaN stays NaN. Maximum errors: kernels/tanh-inl.hpp.
  void (*sigmoid)(const float* x, size_t count, float* out);
  void (*tanh)(const float* x, size_t count, float* out);
  const RodKernels* rods;
  const RodTouchKernels* rod_touches;
  const RodForceKernels* rod_forces;
  const SurfaceWalks* surface_walks;
};

// The table of the active instruction set. Thread-safe. SINEW_API: sinew::embree asks, too.
SINEW_API const Kernels& kernels() noexcept;

// Every table that this build has. Best first; null where a target was not compiled. A table may stand twice
// at the end (Highway's fallback).
std::span<const Kernels* const> compiled_kernels() noexcept;

}  // namespace sinew::simd

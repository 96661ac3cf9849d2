// deep_emulator.cpp  Puts patches together, a range of nodes at a time; the arithmetic is
// kernels/network/mlp-inl.hpp.
#include "tissue/network/deep_emulator.hpp"

#include <algorithm>
#include <utility>

#include "kernels/kernels.hpp"
#include "pack/dense_layout.hpp"

namespace sinew::tissue {
namespace {

using pack::kDeepChainLayers;
using simd::kRangeNodes;
using simd::Pointwise;

constexpr uint32_t kAlpha = 0, kBeta = kDeepChainLayers, kGamma = 2 * kDeepChainLayers;  // first layers
constexpr uint32_t kMotion = 15, kCentre = 18, kNeighbour = 22;
constexpr size_t kOutWidth = 16;
constexpr size_t kCentreStride = 32, kNeighbourStride = 32;

// Of alpha's and beta's answers.
struct Widths {
  size_t alpha, beta;
};

Widths widths_of(const DeepEmulator& network) {
  return {network.layers[kAlpha].padded, network.layers[kBeta].padded};
}

// Rows of kRangeNodes nodes, but `neighbour` of as many edges.
struct Buffers {
  float *centre, *neighbour, *alpha, *start, *sum, *beta_bias, *beta, *out, *mlp;
};

Buffers cut(float* scratch, const Widths& width) {
  const auto take = [&](size_t floats) { return std::exchange(scratch, scratch + kRangeNodes * floats); };
  return {take(kCentreStride), take(kNeighbourStride), take(width.alpha), take(width.beta), take(width.beta),
          take(width.beta),    take(width.beta),       take(kOutWidth),   scratch};
}

constexpr Widths kWidest = {pack::kDeepWidest / 3, pack::kDeepWidest / 3 * 2};
constexpr size_t kRowFloats = kCentreStride + kNeighbourStride + kWidest.alpha + 4 * kWidest.beta + kOutWidth;

// The nodes of a range that are predicted, and the edges of a part of them: which of the nodes is an edge's
// centre.
struct Patches {
  uint32_t nodes[kRangeNodes];
  uint32_t node_count = 0;
  uint32_t degrees[kRangeNodes];
  uint32_t centres[kRangeNodes];
  uint32_t edge_count = 0;
};

struct Step {
  const DeepEmulator& network;
  const Neighbours& neighbours;
  const DeepFrame& frame;
  float* u_next;
  Widths width;
  Buffers at;

  // Layers first .. first + count of the network, from `parts` to out [rows][width of the last].
  simd::MlpJob job(uint32_t first, uint32_t count, float* out) const {
    simd::MlpJob job;
    job.layers = &network.layers[first];
    job.layer_count = count;
    job.weights = network.weights;
    job.widest = pack::kDeepWidest;
    job.between = Pointwise::kTanh;
    job.out = out;
    job.out_stride = job.layers[count - 1].padded;
    job.scratch = at.mlp;
    return job;
  }
};

// Where patches of one node are seen from, s ticks after t.
class Sight {
 public:
  Sight(const DeepFrame& frame, uint32_t centre) : view_(frame.views ? &frame.views[centre] : nullptr) {
    const size_t at = size_t{centre} * 3;
    for (size_t axis = 0; axis < 3; ++axis) {
      const float from = frame.x_now[at + axis];
      for (float* origin : {ahead_, now_, behind_}) origin[axis] = from;
      if (!view_) continue;
      const float goes_on = frame.u_now[at + axis] - frame.u_before[at + axis], falls = view_->fall_m[axis];
      ahead_[axis] += goes_on + falls;
      behind_[axis] -= goes_on;
    }
  }
  const float* ahead() const { return ahead_; }
  const float* now() const { return now_; }
  const float* behind() const { return behind_; }

  float* put(const float* positions, uint32_t node, const float* origin, float* out) const {
    float offset[3];
    for (size_t axis = 0; axis < 3; ++axis) offset[axis] = positions[size_t{node} * 3 + axis] - origin[axis];
    if (!view_) return std::copy_n(offset, 3, out);
    const float per_m = 1 / view_->length_m;
    for (size_t row = 0; row < 3; ++row) {
      const float* axes = view_->axes + 3 * row;
      *out++ = per_m * (axes[0] * offset[0] + axes[1] * offset[1] + axes[2] * offset[2]);
    }
    return out;
  }
  // u_t, u_{t-1}, u_{t-2} of a node.
  float* put_dynamic(const DeepFrame& frame, uint32_t node, float* out) const {
    const float *at_t = out, *before = put(frame.u_now, node, now_, out);
    out = put(frame.u_before, node, behind_, out + 3);
    if (!view_) return put(frame.u_before_that, node, now_, out);
    for (size_t axis = 0; axis < 3; ++axis) *out++ = 2 * before[axis] - at_t[axis];
    return out;
  }
  // u_{t+1} of what gamma says.
  void answer(const DeepFrame& frame, uint32_t node, const float* says, float* u_next) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t at = size_t{node} * 3 + axis;
      if (!view_) {
        u_next[at] = frame.u_now[at] + says[axis];
        continue;
      }
      const float* axes = view_->axes + axis;
      const float moved = axes[0] * says[0] + axes[3] * says[1] + axes[6] * says[2];
      u_next[at] = frame.u_now[at] + (frame.u_now[at] - frame.u_before[at]) + view_->fall_m[axis] +
                   view_->length_m * moved;
    }
  }

 private:
  const PatchView* view_;
  float ahead_[3], now_[3], behind_[3];
};

void put_centre(const DeepFrame& frame, uint32_t node, float* out) {
  const Sight sight(frame, node);
  out = sight.put_dynamic(frame, node, out);
  out = sight.put(frame.x_next, node, sight.ahead(), out);
  out = sight.put(frame.x_before, node, sight.behind(), out);
  std::copy_n(&frame.material[size_t{node} * 3], 3, out);
}

void put_neighbour(const DeepFrame& frame, const Sight& sight, uint32_t node, float* out) {
  out = sight.put_dynamic(frame, node, out);
  out = sight.put(frame.x_next, node, sight.ahead(), out);
  out = sight.put(frame.x_now, node, sight.now(), out);
  out = sight.put(frame.x_before, node, sight.behind(), out);
  out = std::copy_n(&frame.material[size_t{node} * 3], 3, out);
  *out = frame.constrained[node] != 0 ? 1.0f : 0.0f;
}

// Alpha, and where beta's first layer starts: bias and centre.
void hear_centres(const Step& step, const Patches& patches) {
  for (uint32_t i = 0; i < patches.node_count; ++i)
    put_centre(step.frame, patches.nodes[i], step.at.centre + i * kCentreStride);
  simd::MlpJob alpha = step.job(kAlpha, kDeepChainLayers, step.at.alpha);
  alpha.parts[alpha.part_count++] = {step.at.centre, kCentreStride, kCentre, nullptr};
  simd::kernels().mlp(alpha, 0, patches.node_count);
  simd::MlpJob start = step.job(kBeta, 1, step.at.start);
  start.parts[start.part_count++] = {step.at.centre, kCentreStride, kMotion, nullptr};
  simd::kernels().mlp(start, 0, patches.node_count);
}

// Beta's hidden layers of the edges that are waiting, added up at their centres.
void hear_edges(const Step& step, Patches* patches) {
  simd::MlpJob beta = step.job(kBeta, kDeepChainLayers - 1, step.at.sum);
  beta.parts[beta.part_count++] = {step.at.neighbour, kNeighbourStride, kNeighbour, nullptr};
  beta.first_input = kMotion;
  beta.start = {step.at.start, step.width.beta, 0, patches->centres};
  beta.last = Pointwise::kTanh;
  beta.adds = true;
  beta.out_index = patches->centres;
  simd::kernels().mlp(beta, 0, std::exchange(patches->edge_count, 0));
}

void hear_neighbours(const Step& step, Patches* patches) {
  std::fill_n(step.at.sum, patches->node_count * step.width.beta, 0.0f);
  for (uint32_t i = 0; i < patches->node_count; ++i) {
    const uint32_t node = patches->nodes[i];
    const Sight sight(step.frame, node);
    patches->degrees[i] = 0;
    for (uint32_t e = step.neighbours.rows[node]; e < step.neighbours.rows[node + 1]; ++e) {
      if (step.neighbours.columns[e] == node) continue;
      float* row = step.at.neighbour + patches->edge_count * kNeighbourStride;
      put_neighbour(step.frame, sight, step.neighbours.columns[e], row);
      ++patches->degrees[i];
      patches->centres[patches->edge_count++] = i;
      if (patches->edge_count == kRangeNodes) hear_edges(step, patches);
    }
  }
  hear_edges(step, patches);
}

// Beta's last layer of the sums: its bias once a neighbour.
void finish_beta(const Step& step, const Patches& patches) {
  const float* bias = step.network.weights + step.network.layers[kGamma - 1].bias;
  const size_t width = step.width.beta;
  for (uint32_t i = 0; i < patches.node_count; ++i) {
    const auto degree = static_cast<float>(patches.degrees[i]);
    float* row = step.at.beta_bias + i * width;
    for (size_t j = 0; j < width; ++j) row[j] = degree * bias[j];
  }
  simd::MlpJob beta = step.job(kGamma - 1, 1, step.at.beta);
  beta.parts[beta.part_count++] = {step.at.sum, width, static_cast<uint32_t>(width), nullptr};
  beta.start = {step.at.beta_bias, width, 0, nullptr};
  simd::kernels().mlp(beta, 0, patches.node_count);
}

void predict(const Step& step, const Patches& patches) {
  simd::MlpJob gamma = step.job(kGamma, kDeepChainLayers, step.at.out);
  const auto [alpha, beta] = step.width;
  gamma.parts[gamma.part_count++] = {step.at.alpha, alpha, static_cast<uint32_t>(alpha), nullptr};
  gamma.parts[gamma.part_count++] = {step.at.beta, beta, static_cast<uint32_t>(beta), nullptr};
  simd::kernels().mlp(gamma, 0, patches.node_count);
  for (uint32_t i = 0; i < patches.node_count; ++i) {
    const uint32_t node = patches.nodes[i];
    Sight(step.frame, node).answer(step.frame, node, step.at.out + i * kOutWidth, step.u_next);
  }
}

void predict_patches(const Step& step, Patches* patches) {
  if (patches->node_count == 0) return;
  hear_centres(step, *patches);
  hear_neighbours(step, patches);
  finish_beta(step, *patches);
  predict(step, *patches);
  patches->node_count = 0;
}

}  // namespace

size_t deep_emulator_scratch_floats() noexcept {
  return kRangeNodes * kRowFloats + simd::mlp_floats(pack::kDeepWidest);
}

void deep_emulator_step(const DeepEmulator& network, const Neighbours& neighbours, const DeepFrame& frame,
                        uint32_t first, uint32_t last, float* u_next, float* scratch) noexcept {
  const Widths width = widths_of(network);
  const Step step = {network, neighbours, frame, u_next, width, cut(scratch, width)};
  Patches patches;
  for (uint32_t node = first; node < last; ++node) {
    if (frame.constrained[node] != 0) {
      std::copy_n(&frame.x_next[size_t{node} * 3], 3, &u_next[size_t{node} * 3]);
      continue;
    }
    patches.nodes[patches.node_count++] = node;
    if (patches.node_count == kRangeNodes) predict_patches(step, &patches);
  }
  predict_patches(step, &patches);
}

}  // namespace sinew::tissue

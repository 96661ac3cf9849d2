// deep_emulator.cpp  Puts patches together, a range of nodes at a time; the arithmetic is simd/mlp-inl.hpp.
#include "tissue/deep_emulator.hpp"

#include <algorithm>
#include <utility>

#include "pack/dense_layout.hpp"
#include "simd/kernels.hpp"

namespace sinew::tissue {
namespace {

using pack::kDeepChainLayers;
using simd::kRangeNodes;
using simd::Pointwise;

constexpr uint32_t kAlpha = 0, kBeta = kDeepChainLayers, kGamma = 2 * kDeepChainLayers;  // first layers
constexpr uint32_t kMotion = 15, kCentre = 18, kNeighbour = 22;
constexpr size_t kAlphaWidth = 64, kBetaWidth = 128, kOutWidth = 16;
constexpr size_t kCentreStride = 32, kNeighbourStride = 32;

// Rows of kRangeNodes nodes, but `neighbour` of as many edges.
struct Buffers {
  float *centre, *neighbour, *alpha, *start, *sum, *beta_bias, *beta, *out, *mlp;
};

Buffers cut(float* scratch) {
  const auto take = [&](size_t width) { return std::exchange(scratch, scratch + kRangeNodes * width); };
  return {take(kCentreStride), take(kNeighbourStride), take(kAlphaWidth), take(kBetaWidth), take(kBetaWidth),
          take(kBetaWidth),    take(kBetaWidth),       take(kOutWidth),   scratch};
}

constexpr size_t kRowFloats = kCentreStride + kNeighbourStride + kAlphaWidth + 4 * kBetaWidth + kOutWidth;

// The nodes of a range that are predicted, and the edges of a part of them: which of the nodes is an edge's
// centre.
struct Patches {
  uint32_t nodes[kRangeNodes];
  uint32_t node_count = 0;
  uint32_t centres[kRangeNodes];
  uint32_t edge_count = 0;
};

struct Step {
  const DeepEmulator& network;
  const Neighbours& neighbours;
  const DeepFrame& frame;
  float* u_next;
  Buffers at;

  uint32_t degree(uint32_t node) const { return neighbours.rows[node + 1] - neighbours.rows[node]; }
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

float* put_offset(const float* positions, uint32_t node, const float* origin, float* out) {
  for (size_t axis = 0; axis < 3; ++axis) *out++ = positions[size_t{node} * 3 + axis] - origin[axis];
  return out;
}

void put_centre(const DeepFrame& frame, uint32_t node, float* out) {
  const float* origin = &frame.x_now[size_t{node} * 3];
  for (const float* positions :
       {frame.u_now, frame.u_before, frame.u_before_that, frame.x_next, frame.x_before})
    out = put_offset(positions, node, origin, out);
  std::copy_n(&frame.material[size_t{node} * 3], 3, out);
}

void put_neighbour(const DeepFrame& frame, uint32_t centre, uint32_t node, float* out) {
  const float* origin = &frame.x_now[size_t{centre} * 3];
  for (const float* positions :
       {frame.u_now, frame.u_before, frame.u_before_that, frame.x_next, frame.x_now, frame.x_before})
    out = put_offset(positions, node, origin, out);
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
  beta.start = {step.at.start, kBetaWidth, 0, patches->centres};
  beta.last = Pointwise::kTanh;
  beta.adds = true;
  beta.out_index = patches->centres;
  simd::kernels().mlp(beta, 0, std::exchange(patches->edge_count, 0));
}

void hear_neighbours(const Step& step, Patches* patches) {
  std::fill_n(step.at.sum, patches->node_count * kBetaWidth, 0.0f);
  for (uint32_t i = 0; i < patches->node_count; ++i) {
    const uint32_t node = patches->nodes[i];
    for (uint32_t e = step.neighbours.rows[node]; e < step.neighbours.rows[node + 1]; ++e) {
      float* row = step.at.neighbour + patches->edge_count * kNeighbourStride;
      put_neighbour(step.frame, node, step.neighbours.columns[e], row);
      patches->centres[patches->edge_count++] = i;
      if (patches->edge_count == kRangeNodes) hear_edges(step, patches);
    }
  }
  hear_edges(step, patches);
}

// Beta's last layer of the sums: its bias once a neighbour.
void finish_beta(const Step& step, const Patches& patches) {
  const float* bias = step.network.weights + step.network.layers[kGamma - 1].bias;
  for (uint32_t i = 0; i < patches.node_count; ++i) {
    const auto degree = static_cast<float>(step.degree(patches.nodes[i]));
    float* row = step.at.beta_bias + i * kBetaWidth;
    for (size_t j = 0; j < kBetaWidth; ++j) row[j] = degree * bias[j];
  }
  simd::MlpJob beta = step.job(kGamma - 1, 1, step.at.beta);
  beta.parts[beta.part_count++] = {step.at.sum, kBetaWidth, static_cast<uint32_t>(kBetaWidth), nullptr};
  beta.start = {step.at.beta_bias, kBetaWidth, 0, nullptr};
  simd::kernels().mlp(beta, 0, patches.node_count);
}

void predict(const Step& step, const Patches& patches) {
  simd::MlpJob gamma = step.job(kGamma, kDeepChainLayers, step.at.out);
  gamma.parts[gamma.part_count++] = {step.at.alpha, kAlphaWidth, static_cast<uint32_t>(kAlphaWidth), nullptr};
  gamma.parts[gamma.part_count++] = {step.at.beta, kBetaWidth, static_cast<uint32_t>(kBetaWidth), nullptr};
  simd::kernels().mlp(gamma, 0, patches.node_count);
  for (uint32_t i = 0; i < patches.node_count; ++i) {
    const size_t at = size_t{patches.nodes[i]} * 3;
    for (size_t axis = 0; axis < 3; ++axis)
      step.u_next[at + axis] = step.frame.u_now[at + axis] + step.at.out[i * kOutWidth + axis];
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
  const Step step = {network, neighbours, frame, u_next, cut(scratch)};
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

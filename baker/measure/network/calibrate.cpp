// calibrate.cpp  What each layer of a network hears over a roll-out, for the scales of its int8 form.
#include "baker/measure/network/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

#include "baker/common/bad_input.hpp"
#include "baker/measure/network/roll_out.hpp"
#include "baker/pack/network/network_pack.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kSteps = 50, kRings = 12, kSpokes = 24, kNodes = kRings * kSpokes;

// ---- what is heard ----

// A range that is NaN stays so, whatever follows.
void raise(float value, float* range) {
  if (std::isnan(*range)) return;
  if (!(std::fabs(value) <= *range)) *range = std::fabs(value);
}

// Largest magnitudes of each channel of x [nodes][padded].
void raise_all(const float* x, size_t nodes, size_t padded, std::vector<float>* ranges) {
  for (size_t node = 0; node < nodes; ++node) {
    for (size_t j = 0; j < ranges->size(); ++j) raise(x[node * padded + j], &(*ranges)[j]);
  }
}

// The same of P x.
void raise_aggregated(const GraphRows& graph, const float* x, size_t padded, std::vector<float>* ranges) {
  std::vector<double> sum(ranges->size());
  for (size_t node = 0; node + 1 < graph.rows.size(); ++node) {
    std::ranges::fill(sum, 0.0);
    for (uint32_t e = graph.rows[node]; e < graph.rows[node + 1]; ++e) {
      for (size_t j = 0; j < sum.size(); ++j)
        sum[j] += double{graph.values[e]} * x[graph.columns[e] * padded + j];
    }
    for (size_t j = 0; j < sum.size(); ++j) raise(static_cast<float>(sum[j]), &(*ranges)[j]);
  }
}

void raise_layers(const tissue::Network& network, const GraphRows& graph, float* state,
                  std::vector<HeardRanges>* out) {
  const auto nodes = static_cast<uint32_t>(graph.rows.size() - 1);
  for (uint32_t l = 0; l < out->size(); ++l) {
    const tissue::LayerState layer = tissue::layer_state(network, nodes, l, state);
    const size_t padded = network.layers[l].padded;
    raise_aggregated(graph, layer.h, padded, &(*out)[l].h);
    raise_all(layer.y, nodes, padded, &(*out)[l].y);
    if (l + 1 == out->size()) continue;
    raise_aggregated(graph, layer.c, padded, &(*out)[l + 1].px);
    raise_all(layer.c, nodes, padded, &(*out)[l + 1].x);
  }
}

void check_finite(const std::vector<HeardRanges>& ranges, const std::string& path) {
  for (const HeardRanges& layer : ranges) {
    for (const std::vector<float>* kind : {&layer.px, &layer.x, &layer.h, &layer.y}) {
      if (std::ranges::any_of(*kind, [](float v) { return !std::isfinite(v); }))
        throw BadInput(path +
                       ": the network leaves finite numbers on these vectors, so nothing can be scaled by "
                       "them; calibrate with others");
    }
  }
}

std::vector<HeardRanges> nothing_heard(const tissue::Network& network) {
  std::vector<HeardRanges> ranges;
  for (size_t l = 0; l + 1 < network.layers.size(); ++l) {
    const size_t inputs = network.layers[l].inputs, channels = network.layers[l].channels;
    ranges.push_back({std::vector<float>(inputs), std::vector<float>(inputs), std::vector<float>(channels),
                      std::vector<float>(channels)});
  }
  return ranges;
}

// ---- a made-up motion ----

std::vector<int32_t> sphere_edges() {
  std::vector<int32_t> edges;
  for (size_t node = 0; node < kNodes; ++node) {
    const size_t ring = node / kSpokes, beside = ring * kSpokes + (node + 1) % kSpokes;
    edges.insert(edges.end(), {static_cast<int32_t>(node), static_cast<int32_t>(beside)});
    if (ring + 1 < kRings)
      edges.insert(edges.end(), {static_cast<int32_t>(node), static_cast<int32_t>(node + kSpokes)});
  }
  return edges;
}

// A unit sphere that sways by 0.3 and turns by 0.5 rad, each at a few Hz.
std::vector<float> swaying_sphere() {
  std::vector<float> x;
  for (size_t t = 0; t <= kSteps; ++t) {
    const double phase = 0.3 * static_cast<double>(t), turn = 0.5 * std::sin(0.7 * phase);
    for (size_t node = 0; node < kNodes; ++node) {
      const double up = std::numbers::pi * (static_cast<double>(node / kSpokes) + 0.5) / kRings;
      const double around = 2 * std::numbers::pi * static_cast<double>(node % kSpokes) / kSpokes + turn;
      for (const double v : {std::sin(up) * std::cos(around) + 0.3 * std::sin(phase),
                             std::cos(up) + 0.3 * std::sin(1.3 * phase),
                             std::sin(up) * std::sin(around) + 0.3 * std::sin(0.6 * phase)})
        x.push_back(static_cast<float>(v));
    }
  }
  return x;
}

// Every input of every node on a random walk that is pulled back to zero, a third of its envelope wide.
std::vector<float> wandering_inputs(const tissue::Network& network) {
  std::vector<float> width;
  for (const pack::InputRecord& input : network.inputs)
    width.insert(width.end(), input_width(input.kind),
                 std::isfinite(input.envelope) ? input.envelope / 3 : 1);
  std::mt19937 random(1);
  std::vector<float> now(kNodes * width.size()), z;
  for (size_t t = 0; t < kSteps; ++t) {
    for (size_t k = 0; k < now.size(); ++k) {
      const float push = static_cast<float>(random() >> 8) * 0x1p-23f - 1;  // -1..1
      now[k] = 0.9f * now[k] + 0.75f * push * width[k % width.size()];
    }
    z.insert(z.end(), now.begin(), now.end());
  }
  return z;
}

}  // namespace

std::vector<HeardRanges> heard_ranges(const tissue::Network& network, const Safetensors& vectors) {
  std::vector<HeardRanges> ranges = nothing_heard(network);
  roll_out(network, vectors,
           [&](const GraphRows& graph, float* state) { raise_layers(network, graph, state, &ranges); });
  check_finite(ranges, vectors.path);
  return ranges;
}

Safetensors made_up_vectors(const tissue::Network& network) {
  Safetensors vectors;
  vectors.path = "made-up motion";
  vectors.metadata = {{"sinew.vectors", "alt_conv_lstm"}};
  const std::vector<int32_t> edges = sphere_edges();
  vectors.tensors["edges"] = tensor_i32({edges.size() / 2, 2}, edges);
  vectors.tensors["y"] = tensor_f32({kSteps, kNodes, 3}, std::vector<float>(kSteps * kNodes * 3));
  std::vector<float> start(kNodes * 3);
  if (network.inputs.empty()) {
    const std::vector<float> x = swaying_sphere();
    std::copy_n(x.begin(), start.size(), start.begin());
    vectors.tensors["x"] = tensor_f32({kSteps + 1, kNodes, 3}, x);
  } else {
    vectors.tensors["z"] =
        tensor_f32({kSteps, kNodes, network.record->input_width}, wandering_inputs(network));
  }
  vectors.tensors["y0"] = tensor_f32({kNodes, 3}, start);
  return vectors;
}

std::string vectors_beside(const std::string& weights_path) {
  for (const std::string end : {".weights.safetensors", ".safetensors"}) {
    if (!weights_path.ends_with(end)) continue;
    const std::string path =
        weights_path.substr(0, weights_path.size() - end.size()) + ".vectors.safetensors";
    return std::filesystem::exists(path) ? path : "";
  }
  return "";
}

}  // namespace sinew::baker

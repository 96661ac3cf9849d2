// roll_out.cpp  A network run over reference vectors, its own output fed back.
#include "baker/measure/network/roll_out.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "baker/common/bad_input.hpp"
#include "baker/measure/network/reference_vectors.hpp"
#include "baker/pack/network/graph.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "tissue/network/inputs.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kAxes = 3;

// ---- of a network in any precision ----

const tissue::Network& floats_of(const tissue::Network& network) { return network; }
const tissue::Network& floats_of(const ReducedNetwork& network) { return network.floats; }

float* output_of(const tissue::Network& network, uint32_t nodes, float* state) {
  return tissue::layer_state(network, nodes, static_cast<uint32_t>(network.layers.size() - 1), state).y;
}
float* output_of(const ReducedNetwork& network, uint32_t nodes, float* state) {
  return last_state(network, nodes, state).y;
}

tissue::LayerState values_of(const tissue::Network& network, uint32_t nodes, uint32_t layer, float* state) {
  return tissue::layer_state(network, nodes, layer, state);
}
LayerValues values_of(const ReducedNetwork& network, uint32_t nodes, uint32_t layer, float* state) {
  return layer_values(network, nodes, layer, state);
}

// What is needed to take steps, whatever feeds them.
template <class Network>
class Stepper {
 public:
  Stepper(const Network& network, const Safetensors& vectors, const AfterStep& after_step)
      : network_(network),
        after_step_(after_step),
        vectors_(vectors),
        nodes_(vectors.need("y0", {-1, 3}).shape[0]),
        steps_(vectors.need("y", {-1, static_cast<long>(nodes_), 3}).shape[0]),
        rows_(normalized_adjacency(nodes_, read_edges(vectors), vectors.path + ": tensor 'edges'")),
        y0_(vectors.tensors.at("y0").as_f32()),
        expected_(vectors.tensors.at("y").as_f32()),
        stride_(tissue::input_stride(floats_of(network))),
        z_(nodes_ * stride_),
        state_(state_floats(network, count())),
        scratch_(scratch_floats(network, count())) {
    float* y = output_state();
    if (nodes_ == 0 || steps_ == 0)
      throw BadInput(vectors.path + ": holds " + std::to_string(nodes_) + " nodes and " +
                     std::to_string(steps_) + " steps, nothing to check; write the vectors again");
    for (size_t node = 0; node < nodes_; ++node)
      std::copy_n(&y0_[node * kAxes], kAxes, y + node * last_padded());
  }

  size_t nodes() const { return nodes_; }
  size_t steps() const { return steps_; }
  float* input(size_t node) { return z_.data() + node * stride_; }
  const std::vector<float>& start() const { return y0_; }

  // carry: [nodes][3] or null. The output comes back as [nodes][3].
  const std::vector<float>& step(size_t index, const float* carry) {
    const tissue::Graph graph{count(), rows_.rows.data(), rows_.columns.data(), rows_.values.data()};
    network_step(network_, graph, z_.data(), carry, state_.data(), scratch_.data());
    if (after_step_) after_step_(rows_, state_.data());
    output_.resize(nodes_ * kAxes);
    for (size_t k = 0; k < output_.size(); ++k) {
      output_[k] = output_state()[k / kAxes * last_padded() + k % kAxes];
      error_.add(output_[k], expected_[index * output_.size() + k]);
    }
    return output_;
  }

  RollOutError finish() {
    for (uint32_t l = 0; l < layers().size(); ++l)
      compare_planes(l, values_of(network_, count(), l, state_.data()));
    return error_.result(steps_);
  }

 private:
  uint32_t count() const { return static_cast<uint32_t>(nodes_); }
  std::span<const pack::LayerRecord> layers() const { return floats_of(network_).layers; }
  uint32_t last_padded() const { return layers().back().padded; }
  float* output_state() { return output_of(network_, count(), state_.data()); }

  // P x, x [nodes][width].
  std::vector<float> aggregated(const std::vector<float>& x, size_t width) const {
    std::vector<double> sum(x.size());
    for (size_t i = 0; i < nodes_; ++i) {
      for (uint32_t e = rows_.rows[i]; e < rows_.rows[i + 1]; ++e) {
        for (size_t j = 0; j < width; ++j)
          sum[i * width + j] += double{rows_.values[e]} * x[rows_.columns[e] * width + j];
      }
    }
    return {sum.begin(), sum.end()};
  }

  template <class Planes>
  void compare_planes(uint32_t l, const Planes& state) {
    const std::string prefix = "final." + std::to_string(l) + ".";
    compare_state(prefix + "h", state.h, layers()[l]);
    compare_state(prefix + "c", state.c, layers()[l]);
    compare_state(prefix + "y", state.y, layers()[l]);
  }

  template <class Values>
  void compare_state(const std::string& name, const Values& values, const pack::LayerRecord& layer) {
    if (!vectors_.tensors.contains(name)) return;
    std::vector<float> expected =
        vectors_.need(name, {static_cast<long>(nodes_), static_cast<long>(layer.channels)}).as_f32();
    const bool is_hidden_y = name.back() == 'y' && &layer != &layers().back();
    if (is_hidden_y) expected = aggregated(expected, layer.channels);  // the runtime keeps P y
    for (size_t k = 0; k < expected.size(); ++k)
      error_.add(values[k / layer.channels * layer.padded + k % layer.channels], expected[k]);
  }

  const Network& network_;
  const AfterStep& after_step_;
  const Safetensors& vectors_;
  size_t nodes_, steps_;
  GraphRows rows_;
  std::vector<float> y0_, expected_, output_;
  size_t stride_;
  AlignedFloats z_, state_, scratch_;
  ErrorSum error_;
};

// Input: X_t, X_t - X_{t-1}, Y_0 - X_0; the last layer carries X_t - X_{t-1} (arXiv 2006.07818 Eq. 9-11).
template <class Network>
RollOutError roll_out_paper(const Network& network, const Safetensors& vectors, const AfterStep& after_step) {
  Stepper<Network> stepper(network, vectors, after_step);
  const size_t floats = stepper.nodes() * kAxes;
  const std::vector<float> x =
      vectors.need("x", {static_cast<long>(stepper.steps() + 1), static_cast<long>(stepper.nodes()), 3})
          .as_f32();
  std::vector<float> motion(floats);
  for (size_t t = 1; t <= stepper.steps(); ++t) {
    const float *now = &x[t * floats], *before = now - floats;
    for (size_t k = 0; k < floats; ++k) {
      motion[k] = now[k] - before[k];
      float* z = stepper.input(k / kAxes) + k % kAxes;
      z[0] = now[k];
      z[kAxes] = motion[k];
      z[2 * kAxes] = stepper.start()[k] - x[k];
    }
    stepper.step(t - 1, motion.data());
  }
  return stepper.finish();
}

// A fed-back input's first column and record; null if the network is not fed it.
struct FeedBack {
  size_t column = 0;
  const pack::InputRecord* record = nullptr;
};

FeedBack find_feed_back(const tissue::Network& network, pack::InputKind kind) {
  size_t column = 0;
  for (const pack::InputRecord& input : network.inputs) {
    if (input.kind == kind) return {column, &input};
    column += input_width(input.kind);
  }
  return {};
}

template <class Network>
void feed_back(const FeedBack& to, size_t k, float value, Stepper<Network>* stepper) {
  if (to.record == nullptr) return;
  const float scaled = std::clamp(value * to.record->scale, -to.record->envelope, to.record->envelope);
  stepper->input(k / kAxes)[to.column + k % kAxes] = scaled;
}

template <class Network>
RollOutError roll_out_inputs(const Network& network, const Safetensors& vectors,
                             const AfterStep& after_step) {
  Stepper<Network> stepper(network, vectors, after_step);
  const size_t width = floats_of(network).record->input_width, nodes = stepper.nodes();
  const std::vector<float> z =
      vectors
          .need("z", {static_cast<long>(stepper.steps()), static_cast<long>(nodes), static_cast<long>(width)})
          .as_f32();
  const bool based = vectors.tensors.contains("carry");
  const std::vector<float> carry =
      based
          ? vectors.need("carry", {static_cast<long>(stepper.steps()), static_cast<long>(nodes), 3}).as_f32()
          : std::vector<float>();
  const FeedBack displacement = find_feed_back(floats_of(network), pack::InputKind::kDisplacement);
  const FeedBack velocity = find_feed_back(floats_of(network), pack::InputKind::kVelocity);
  std::vector<float> now = stepper.start(), before = now;
  for (size_t t = 0; t < stepper.steps(); ++t) {
    for (size_t node = 0; node < nodes; ++node)
      std::copy_n(&z[(t * nodes + node) * width], width, stepper.input(node));
    for (size_t k = 0; k < now.size(); ++k) {
      feed_back(displacement, k, now[k], &stepper);
      feed_back(velocity, k, now[k] - before[k], &stepper);
    }
    before = std::exchange(now, stepper.step(t, based ? &carry[t * now.size()] : nullptr));
  }
  return stepper.finish();
}

template <class Network>
RollOutError roll_out_any(const Network& network, const Safetensors& vectors, const AfterStep& after_step) {
  check_vectors(vectors, "alt_conv_lstm");
  const bool paper = floats_of(network).inputs.empty();
  if (paper != vectors.tensors.contains("x"))
    throw BadInput(vectors.path + ": these vectors are of " +
                   (paper ? "stated inputs (z)" : "the paper's wiring (x)") +
                   ", the network is of the other; check it with vectors that were written with it");
  return paper ? roll_out_paper(network, vectors, after_step) : roll_out_inputs(network, vectors, after_step);
}

}  // namespace

RollOutError roll_out(const tissue::Network& network, const Safetensors& vectors,
                      const AfterStep& after_step) {
  return roll_out_any(network, vectors, after_step);
}

RollOutError roll_out(const ReducedNetwork& network, const Safetensors& vectors) {
  return roll_out_any(network, vectors, {});
}

}  // namespace sinew::baker

// block_network.cpp  The soft block's network: a correction of its modes, as a weights file in memory.
#include "tests/scenes/block_network.hpp"

#include <cmath>
#include <random>

namespace sinew::scenes {
namespace {

using baker::Safetensors;

// felt_step, base_step, gravity_change, angular velocity and acceleration, displacement, velocity, turn; then
// stiffness and frequency, which are never zero.
constexpr size_t kVectors = 8, kScalars = 2, kInputs = 3 * kVectors + kScalars;
constexpr size_t kFeltStep = 0, kDisplacement = 5;  // among the vectors
constexpr size_t kHidden = 8, kOutput = 3;
constexpr size_t kGateI = 0, kGateF = 1, kGateC = 2, kGates = 4;
constexpr double kOpen = 12;     // a bias that holds a gate open, or shut when negative
constexpr double kLinear = 0.1;  // tanh(0.1 x) is 0.1 x for the numbers that come in
// c' = kKept c + kPull (felt_step - displacement); y gains c. The base pulls by (w h)^2 = 0.13.
constexpr double kKept = 0.5, kPull = 0.03;

// [rows][gates][channels], filled with small random numbers.
struct Weights {
  size_t gates, channels;
  std::vector<float> values;
  float& at(size_t row, size_t gate, size_t channel) {
    return values[(row * gates + gate) * channels + channel];
  }
};

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  Weights weights(size_t rows, size_t gates, size_t channels) {
    constexpr float kSmall = 0.01f;
    Weights made{gates, channels, std::vector<float>(rows * gates * channels)};
    for (float& value : made.values) value = kSmall * (static_cast<float>(engine_() % 2001) / 1000 - 1);
    return made;
  }

 private:
  std::mt19937_64 engine_;
};

void put(Safetensors& file, const std::string& name, const Weights& w) {
  const size_t columns = w.gates * w.channels;
  const bool vector = name.ends_with(".b");
  file.tensors[name] = baker::tensor_f32(
      vector ? std::vector<size_t>{columns} : std::vector<size_t>{w.values.size() / columns, columns},
      w.values);
}

void put_layer(Safetensors& file, size_t index, const Weights& around, const Weights& self,
               const Weights& bias, Random& random) {
  const size_t channels = self.channels;
  const std::string prefix = "layers." + std::to_string(index) + ".";
  put(file, prefix + "W_x", around);
  put(file, prefix + "W_s", self);
  put(file, prefix + "W_h", random.weights(channels, kGates, channels));
  put(file, prefix + "W_y", random.weights(channels, 3, channels));
  put(file, prefix + "b", bias);
}

// Cells 0..2: tanh of the felt step; 3..5: of the displacement; no memory (f shut, i open).
void put_first_layer(Safetensors& file, Random& random) {
  Weights around = random.weights(kInputs, kGates, kHidden), self = random.weights(kInputs, kGates, kHidden);
  Weights bias = random.weights(1, kGates, kHidden);
  for (size_t channel = 0; channel < kHidden; ++channel) {
    bias.at(0, kGateI, channel) = static_cast<float>(kOpen);
    bias.at(0, kGateF, channel) = static_cast<float>(-kOpen);
    bias.at(0, kGateC, channel) = 0;
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    self.at(3 * kFeltStep + axis, kGateC, axis) = static_cast<float>(kLinear);
    self.at(3 * kDisplacement + axis, kGateC, 3 + axis) = static_cast<float>(kLinear);
  }
  // What is never zero may not push, or rest would not be rest.
  for (size_t scalar = kInputs - kScalars; scalar < kInputs; ++scalar) {
    for (size_t channel = 0; channel < kHidden; ++channel)
      around.at(scalar, kGateC, channel) = self.at(scalar, kGateC, channel) = 0;
  }
  put_layer(file, 0, around, self, bias, random);
}

void put_last_layer(Safetensors& file, Random& random) {
  const Weights around = random.weights(kHidden, kGates, kOutput);
  Weights self = random.weights(kHidden, kGates, kOutput), bias = random.weights(1, kGates, kOutput);
  for (size_t axis = 0; axis < kOutput; ++axis) {
    bias.at(0, kGateI, axis) = static_cast<float>(kOpen);
    bias.at(0, kGateF, axis) = static_cast<float>(std::log(kKept / (1 - kKept)));
    bias.at(0, kGateC, axis) = 0;
    self.at(axis, kGateC, axis) = static_cast<float>(kPull / kLinear);
    self.at(3 + axis, kGateC, axis) = static_cast<float>(-kPull / kLinear);
  }
  put_layer(file, 1, around, self, bias, random);
}

}  // namespace

baker::Safetensors block_network(const BlockOptions& options) {
  Safetensors file;
  file.path = options.name + " (in memory)";
  file.metadata = {
      {"sinew.model", "alt_conv_lstm"},
      {"sinew.version", "1"},
      {"channels", "8,3"},
      {"rate_hz", std::to_string(options.rate_hz)},
      {"frame", "bent"},
      {"base", "modal_2"},
      {"inputs",
       "felt_step,base_step,gravity_change,angular_velocity,angular_acceleration,displacement,velocity,turn,"
       "stiffness,frequency"},
      {"input_scales", "1,4,0.05,0.2,0.02,1,4,1,1,1"},
      {"envelope", "5,5,5,5,5,20,20,5,1,1"},
      {"hidden_leak", "0.2"},
      {"state_clamp", "8"},
      {"length_unit", "0.25"}};
  Random random(options.seed);
  put_first_layer(file, random);
  put_last_layer(file, random);
  return file;
}

}  // namespace sinew::scenes

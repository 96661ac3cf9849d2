// block_network.cpp  The soft block's network: a damped spring a node, as a weights file in memory.
#include "tests/scenes/block_network.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace sinew::scenes {
namespace {

using baker::Safetensors;

constexpr size_t kDriveInputs = 5,
                 kInputs = 3 * kDriveInputs + 3 + 1;  // accelerations, displacement, stiffness
constexpr size_t kHidden = 8, kOutput = 3;
constexpr size_t kGateI = 0, kGateF = 1, kGateC = 2, kGates = 4;
constexpr double kUnit_m = 0.05, kDriveScale = 0.05;  // a unit of drive is 20 m/s^2
constexpr double kOpen = 12;                          // a bias that holds a gate open, or shut when negative
constexpr double kLinear = 0.1;                       // tanh(0.1 x) is 0.1 x for the numbers that come in
constexpr double kFrequency_hz = 3.5, kDampingRatio = 0.1;

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

// Cells 0..2: tanh of the summed drive; 3..5: of the displacement; no memory (f shut, i open).
void put_first_layer(Safetensors& file, Random& random) {
  Weights around = random.weights(kInputs, kGates, kHidden), self = random.weights(kInputs, kGates, kHidden);
  Weights bias = random.weights(1, kGates, kHidden);
  for (size_t channel = 0; channel < kHidden; ++channel) {
    bias.at(0, kGateI, channel) = static_cast<float>(kOpen);
    bias.at(0, kGateF, channel) = static_cast<float>(-kOpen);
    bias.at(0, kGateC, channel) = 0;
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t drive = 0; drive < kDriveInputs; ++drive) {
      self.at(3 * drive + axis, kGateC, axis) = static_cast<float>(kLinear);
    }
    self.at(3 * kDriveInputs + axis, kGateC, 3 + axis) = static_cast<float>(kLinear);
  }
  // Stiffness is never zero: it may not push, or rest would not be rest.
  for (size_t channel = 0; channel < kHidden; ++channel) {
    around.at(kInputs - 1, kGateC, channel) = self.at(kInputs - 1, kGateC, channel) = 0;
  }
  put_layer(file, 0, around, self, bias, random);
}

// v' = (1 - 2 zeta omega h) v + h^2 a / unit - (omega h)^2 u;  u' = u + v'
void put_spring_layer(Safetensors& file, const BlockOptions& options, Random& random) {
  const double h = 1 / options.rate_hz, omega_h = 2 * std::numbers::pi * kFrequency_hz * h;
  const double kept = 1 - 2 * kDampingRatio * omega_h;
  const double push = h * h / (kDriveScale * kUnit_m) / kLinear, pull = omega_h * omega_h / kLinear;
  const Weights around = random.weights(kHidden, kGates, kOutput);
  Weights self = random.weights(kHidden, kGates, kOutput), bias = random.weights(1, kGates, kOutput);
  for (size_t axis = 0; axis < kOutput; ++axis) {
    bias.at(0, kGateI, axis) = static_cast<float>(kOpen);
    bias.at(0, kGateF, axis) = static_cast<float>(std::log(kept / (1 - kept)));
    bias.at(0, kGateC, axis) = 0;
    self.at(axis, kGateC, axis) = static_cast<float>(push);
    self.at(3 + axis, kGateC, axis) = static_cast<float>(-pull);
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
      {"inputs",
       "linear_acceleration,euler_acceleration,centrifugal_acceleration,articulation_acceleration,"
       "gravity_change,displacement,stiffness"},
      {"input_scales", "0.05,0.05,0.05,0.05,0.05,1,1"},
      {"envelope", "5,5,5,5,5,20,1"},
      {"hidden_leak", "0.2"},
      {"output_leak", "0.002"},
      {"state_clamp", "8"},
      {"length_unit_m", std::to_string(kUnit_m)},
      {"displacement_limit", std::to_string(options.displacement_limit)}};
  Random random(options.seed);
  put_first_layer(file, random);
  put_spring_layer(file, options, random);
  return file;
}

}  // namespace sinew::scenes

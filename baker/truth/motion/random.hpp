// random.hpp  Random numbers that are the same on every machine.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

constexpr double kTau = 2 * std::numbers::pi;

// SplitMix64 (Steele, Lea, Flood 2014). The standard library's distributions differ between implementations.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x632be59bd9b4e019u) {}
  uint64_t next() {
    uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  size_t below(size_t count) { return static_cast<size_t>(uniform(0, static_cast<double>(count))); }
  double sign() { return chance(0.5) ? 1 : -1; }
  Vector3 direction() {
    const double height = uniform(-1, 1), turn = uniform(0, kTau), around = std::sqrt(1 - height * height);
    return {around * std::cos(turn), height, around * std::sin(turn)};
  }

 private:
  uint64_t state_;
};

}  // namespace sinew::baker

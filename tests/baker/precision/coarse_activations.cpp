// coarse_activations.cpp  What int8 layers have for tanh and sigmoid, against the C library in double.
#include <cmath>
#include <cstring>
#include <limits>

#include "baker/research/precision/layer_kernels.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;

namespace {

// The errors stated at CoarseTanh, and as much again as a float rounds by.
constexpr double kCoarseTanh = 4.45e-5, kCoarseSigmoid = 2.25e-5;
constexpr uint32_t kStep = 4093;  // every so many floats; prime, so that the low bits vary

struct Activations {
  std::vector<float> tanh, sigmoid;
};

Activations activations_of(const std::vector<float>& x) {
  const baker::LayerKernels& kernels = *baker::layer_kernels().front();
  Activations out{std::vector<float>(x.size()), std::vector<float>(x.size())};
  kernels.coarse_tanh(x.data(), x.size(), out.tanh.data());
  kernels.coarse_sigmoid(x.data(), x.size(), out.sigmoid.data());
  return out;
}

std::vector<float> sampled_floats() {
  std::vector<float> values;
  for (uint64_t bits = 0; bits <= 0xffffffffu; bits += kStep) {
    float value;
    const auto low = static_cast<uint32_t>(bits);
    std::memcpy(&value, &low, sizeof(value));
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

}  // namespace

TEST_CASE("coarse_activations_are_within_their_stated_error_and_never_beyond_one") {
  const std::vector<float> x = sampled_floats();
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    const auto [t, s] = activations_of(x);
    double worst_t = 0, worst_s = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      const auto exact = static_cast<double>(x[i]);
      worst_t = std::max(worst_t, std::fabs(t[i] - std::tanh(exact)));
      worst_s = std::max(worst_s, std::fabs(s[i] - 1 / (1 + std::exp(-exact))));
      if (!(std::fabs(t[i]) <= 1 && s[i] >= 0 && s[i] <= 1))
        FAIL("of " << x[i] << ": " << t[i] << ", " << s[i]);
    }
    CHECK(worst_t <= kCoarseTanh);
    CHECK(worst_s <= kCoarseSigmoid);
  });
}

TEST_CASE("coarse_activations_keep_nan_and_are_exact_at_zero") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    const auto [t, s] = activations_of({nan, -nan, 0.0f, -0.0f});
    for (const size_t i : {0u, 1u}) REQUIRE((std::isnan(t[i]) && std::isnan(s[i])));
    for (const size_t i : {2u, 3u}) REQUIRE((t[i] == 0 && s[i] == 0.5f));
  });
}

// test_activation.cpp  sigmoid and tanh over the whole of float, against the C library in double.
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/simd/every_isa.hpp"

using namespace sinew;

namespace {

// The largest errors stated in kernels/tanh-inl.hpp: three units in the last place, for P, Q, product and
// quotient each round once. Here every kStep-th float is tried.
constexpr double kTanhRelative = 4e-7;
constexpr double kSigmoidAbsolute = 2.5e-7;
constexpr uint32_t kStep = 4093;  // prime, so that the low bits vary

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float from_bits(uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

// Every kStep-th float, NaN and infinity left out.
std::vector<float> sampled_floats() {
  std::vector<float> values;
  for (uint64_t bits = 0; bits <= 0xffffffffu; bits += kStep) {
    const float value = from_bits(static_cast<uint32_t>(bits));
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

template <class Function>
std::vector<float> mapped(Function function, const std::vector<float>& x) {
  std::vector<float> out(x.size());
  function(x.data(), x.size(), out.data());
  return out;
}

}  // namespace

TEST_CASE("tanh_is_within_its_stated_error_of_the_double_result_over_all_floats") {
  const std::vector<float> x = sampled_floats();
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    const std::vector<float> out = mapped(kernels.tanh, x);
    double worst = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      const double exact = std::tanh(static_cast<double>(x[i]));
      // Below the smallest normal number a relative error means nothing.
      if (std::fabs(exact) >= std::numeric_limits<float>::min())
        worst = std::max(worst, std::fabs(out[i] / exact - 1));
      if (std::fabs(out[i]) > 1) FAIL("tanh(" << x[i] << ") = " << out[i] << " is beyond 1");
    }
    CHECK(worst <= kTanhRelative);
  });
}

TEST_CASE("sigmoid_is_within_its_stated_error_of_the_double_result_over_all_floats") {
  const std::vector<float> x = sampled_floats();
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    const std::vector<float> out = mapped(kernels.sigmoid, x);
    double worst = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      worst = std::max(worst, std::fabs(out[i] - 1 / (1 + std::exp(-static_cast<double>(x[i])))));
      if (!(out[i] >= 0 && out[i] <= 1)) FAIL("sigmoid(" << x[i] << ") = " << out[i] << " is outside 0..1");
    }
    CHECK(worst <= kSigmoidAbsolute);
  });
}

TEST_CASE("activations_keep_nan_and_reach_their_limits") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> x = {nan, -nan, kInfinity, -kInfinity, 0.0f, -0.0f, 1e30f, -1e30f};
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    const std::vector<float> t = mapped(kernels.tanh, x), s = mapped(kernels.sigmoid, x);
    for (const size_t i : {0u, 1u}) REQUIRE((std::isnan(t[i]) && std::isnan(s[i])));
    for (const size_t i : {2u, 6u})
      REQUIRE((t[i] == Approx(1).epsilon(kTanhRelative) && s[i] == Approx(1).epsilon(kTanhRelative)));
    for (const size_t i : {3u, 7u})
      REQUIRE((t[i] == Approx(-1).epsilon(kTanhRelative) && std::fabs(s[i]) <= kSigmoidAbsolute));
    for (const size_t i : {4u, 5u})
      REQUIRE((t[i] == 0 && s[i] == 0.5f && std::signbit(t[i]) == std::signbit(x[i])));
  });
}

TEST_CASE("activations_of_partial_vectors_touch_nothing_beyond_them") {
  constexpr float kUntouched = 77;
  std::vector<float> x(40);
  for (size_t i = 0; i < x.size(); ++i) x[i] = 0.3f * static_cast<float>(i) - 6;
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    const std::vector<float> whole = mapped(kernels.tanh, x);
    for (size_t count = 0; count <= x.size(); ++count) {
      std::vector<float> out(x.size(), kUntouched);
      kernels.tanh(x.data(), count, out.data());
      for (size_t i = 0; i < x.size(); ++i) REQUIRE(out[i] == (i < count ? whole[i] : kUntouched));
    }
  });
}

TEST_CASE("activations_have_the_same_bits_on_all_targets_with_fma") {
  const std::vector<float> x = sampled_floats();
  test::require_same_bits_where_fused(0x578cac7cedd3a869, [&](const simd::Kernels& kernels) {
    std::vector<float> out = mapped(kernels.tanh, x);
    const std::vector<float> s = mapped(kernels.sigmoid, x);
    out.insert(out.end(), s.begin(), s.end());
    return out;
  });
}

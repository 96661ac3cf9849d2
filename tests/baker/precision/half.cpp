// half.cpp  Halves as floats, against the definition of binary16.
#include <catch2/catch.hpp>
#include <cmath>

#include "baker/research/precision/half.hpp"

using namespace sinew;

TEST_CASE("every_half_is_the_float_of_its_sign_exponent_and_mantissa") {
  for (uint32_t bits = 0; bits < 65536; ++bits) {
    const uint32_t exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const float sign = bits < 32768 ? 1.0f : -1.0f, value = baker::half_to_float(static_cast<uint16_t>(bits));
    INFO("half " << bits);
    if (exponent == 31 && mantissa != 0) {
      REQUIRE(std::isnan(value));
    } else if (exponent == 31) {
      REQUIRE(value == sign * INFINITY);
    } else {
      const float whole = static_cast<float>(exponent == 0 ? mantissa : mantissa + 1024);
      REQUIRE(value == sign * std::ldexp(whole, static_cast<int>(exponent == 0 ? 1 : exponent) - 25));
      REQUIRE(std::signbit(value) == (bits >= 32768));
    }
  }
}

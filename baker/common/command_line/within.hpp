// within.hpp  The range of an option that is a number.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace sinew::baker {

// Refuses what is not from low to high: "must be <words>, not ...". NaN is outside every range.
inline CLI::Validator within(double low, double high, const std::string& words) {
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? std::string() : "must be " + words + ", not " + text;
      },
      "");
}

}  // namespace sinew::baker

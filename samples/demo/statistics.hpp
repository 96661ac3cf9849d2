// statistics.hpp  Median, tail and mean of a column of numbers.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace sinew::demo {

struct Spread {
  double median = 0, p99 = 0, max = 0, mean = 0;
};

// p99 is the smallest value that 99 % do not exceed. No values: zeros.
inline Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
    return values[std::max<size_t>(rank, 1) - 1];
  };
  double sum = 0;
  for (const double value : values) sum += value;
  return {at(0.5), at(0.99), values.back(), sum / static_cast<double>(values.size())};
}

// One number of every frame: column(frames, [](const FrameRecord& f) { return f.read_us; }).
template <class Frames, class Get>
std::vector<double> column(const Frames& frames, const Get& get) {
  std::vector<double> out;
  out.reserve(frames.size());
  for (const auto& frame : frames) out.push_back(static_cast<double>(get(frame)));
  return out;
}

}  // namespace sinew::demo

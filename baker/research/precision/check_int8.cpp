// check_int8.cpp  The int8 sections are as long as the layers say, and what the kernels trust is so.
#include <algorithm>
#include <cmath>

#include "baker/pack/network/int8_layout.hpp"
#include "baker/research/precision/check_int8.hpp"
#include "pack/checks/checks.hpp"

namespace sinew::baker {
namespace {

using pack::corrupt, pack::PackView;

struct Int8Part {  // of one layer
  std::span<const int8_t> weights;
  std::span<const int32_t> sums;
};

// 128 times what one column of [groups][gates][width][4] adds up to.
int64_t sum_of(std::span<const int8_t> weights, size_t groups, size_t row, size_t column) noexcept {
  int64_t sum = 0;
  for (size_t group = 0; group < groups; ++group) {
    for (size_t k = 0; k < 4; ++k) sum += weights[(group * row + column) * 4 + k];
  }
  return 128 * sum;
}

// Gates i f c o of 16 channels: [depth / 4][4][16][4], then [padded / 4][2][16][4].
bool block_sums_agree(std::span<const int8_t> block, size_t depth, size_t padded,
                      const int32_t* sums) noexcept {
  for (size_t column = 0; column < 64; ++column) {
    int64_t sum = sum_of(block, depth / 4, 64, column);
    if (column < 32) sum += sum_of(block.subspan(depth * 64), padded / 4, 32, column);
    if (sum != sums[column]) return false;
  }
  return true;
}

bool sums_agree(const Int8Part& part, uint32_t padded, uint32_t depth) noexcept {
  const size_t first = depth - padded, block = 64 * first + 32 * size_t{padded};
  for (size_t k = 0; k < padded / 16; ++k) {
    if (!block_sums_agree(part.weights.subspan(k * block, block), first, padded, &part.sums[k * 64]))
      return false;
  }
  const auto output = part.weights.last(size_t{padded} * padded);
  for (size_t column = 0; column < padded; ++column) {
    if (sum_of(output, padded / 4, padded, column) != part.sums[4 * size_t{padded} + column]) return false;
  }
  return true;
}

Status check_sizes(const PackView& pack) noexcept {
  uint64_t weights = 0, sums = 0, scales = 0;
  for (size_t l = 0; pack.network->precision == pack::Precision::kInt8 && l + 1 < pack.layers.size(); ++l) {
    const Int8Extent extent = int8_extent(pack.layers[l], l == 0);
    weights += extent.weights, sums += extent.sums, scales += extent.scales;
  }
  if (pack.int8_weights.size() != weights || pack.int8_sums.size() != sums ||
      pack.int8_scales.size() != scales)
    return corrupt("int8: %zu weights, %zu sums and %zu scales, the layers make %llu, %llu and %llu",
                   pack.int8_weights.size(), pack.int8_sums.size(), pack.int8_scales.size(),
                   static_cast<unsigned long long>(weights), static_cast<unsigned long long>(sums),
                   static_cast<unsigned long long>(scales));
  return {};
}

Status check_numbers(const PackView& pack) noexcept {
  if (std::ranges::any_of(pack.int8_weights, [](int8_t w) { return w == -128; }))
    return corrupt("int8 weights: a number below -127");
  if (std::ranges::any_of(pack.int8_scales, [](float s) { return !(s >= 0 && std::isfinite(s)); }))
    return corrupt("int8 scales: a number below 0 or not finite");
  return {};
}

Status check_sums(const PackView& pack) noexcept {
  Int8Part rest = {pack.int8_weights, pack.int8_sums};
  for (size_t l = 0; !rest.sums.empty() && l + 1 < pack.layers.size(); ++l) {
    const Int8Extent extent = int8_extent(pack.layers[l], l == 0);
    const Int8Part part = {rest.weights.first(extent.weights), rest.sums.first(extent.sums)};
    if (!sums_agree(part, pack.layers[l].padded, extent.depth))
      return corrupt("layer %zu: int8 sums are not those of the weights", l);
    rest = {rest.weights.subspan(extent.weights), rest.sums.subspan(extent.sums)};
  }
  return {};
}

}  // namespace

Status check_int8(const pack::PackView& pack) noexcept {
  constexpr pack::Check kChecks[] = {check_sizes, check_numbers, check_sums};
  return pack::run_checks(kChecks, pack);
}

}  // namespace sinew::baker

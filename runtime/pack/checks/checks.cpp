// checks.cpp  What the checks of networks, characters and tissue share.
#include "pack/checks/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>

#include "core/status.hpp"

namespace sinew::pack {

Status corrupt(const char* format, ...) noexcept {
  char what[160];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  return core::make_status(StatusCode::kCorrupt, "pack: %s; the file is damaged, bake it again", what);
}

bool has_int8(const PackView& pack) noexcept {
  return !pack.int8_weights.empty() || !pack.int8_sums.empty() || !pack.int8_scales.empty();
}

size_t first_not_finite(std::span<const float> values) noexcept {
  const auto found = std::ranges::find_if(values, [](float v) { return !std::isfinite(v); });
  return static_cast<size_t>(found - values.begin());
}

Status check_finite(std::span<const float> values, const char* section) noexcept {
  const size_t index = first_not_finite(values);
  return index == values.size() ? Status{} : corrupt("%s: number %zu is not finite", section, index);
}

Status check_within(std::span<const float> values, float most, const char* section) noexcept {
  const auto found = std::ranges::find_if(values, [most](float v) { return !(std::fabs(v) <= most); });
  if (found == values.end()) return {};
  return corrupt("%s: number %zu is %g, not within +-%g", section,
                 static_cast<size_t>(found - values.begin()), double{*found}, double{most});
}

Status check_zero(std::span<const uint32_t> reserved, const char* section, size_t index) noexcept {
  const bool zero = std::ranges::all_of(reserved, [](uint32_t v) { return v == 0; });
  return zero ? Status{} : corrupt("%s %zu: reserved fields are not zero", section, index);
}

bool is_unit(const float normal[3]) noexcept {
  constexpr float kTolerance = 2e-3f;  // of the squared length: 1e-3 of the length
  const float squared = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  return std::fabs(squared - 1) <= kTolerance;  // false for NaN
}

bool is_positive(float value) noexcept { return std::isfinite(value) && value > 0; }

bool is_within(float value, float least, float most) noexcept { return value >= least && value <= most; }

bool are_within(std::span<const float> values, float most) noexcept {
  return std::ranges::all_of(values, [most](float v) { return std::fabs(v) <= most; });
}

Status check_name(const PackView& pack, uint32_t offset, const char* section, size_t index) noexcept {
  return offset < pack.strings.size() ? Status{}
                                      : corrupt("%s %zu: its name lies outside the strings", section, index);
}

Status check_skin(const SkinRecord& skin, size_t joint_count, const char* section, size_t index) noexcept {
  constexpr float kSumTolerance = 1e-5f;
  float sum = 0, last = std::numeric_limits<float>::max();
  for (uint32_t k = 0; k < kInfluences; ++k) {
    const float weight = skin.weight[k];
    if (!(weight >= 0 && weight <= last))
      return corrupt("%s %zu: skin weights are not descending from one to zero", section, index);
    if (skin.joint[k] >= joint_count)
      return corrupt("%s %zu: skinned to joint %u of %zu", section, index, skin.joint[k], joint_count);
    if (weight == 0 && skin.joint[k] != 0)
      return corrupt("%s %zu: a joint without skin weight", section, index);
    sum += last = weight;
  }
  return std::fabs(sum - 1) <= kSumTolerance
             ? Status{}
             : corrupt("%s %zu: skin weights sum to %g, not 1", section, index, double{sum});
}

Status run_checks(std::span<const Check> checks, const PackView& pack) noexcept {
  for (Check check : checks)
    if (Status status = check(pack); !status.ok()) return status;
  return {};
}

}  // namespace sinew::pack

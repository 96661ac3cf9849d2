// check_modes.cpp  Modal bases agree with the regions, and none of them can grow.
#include <algorithm>
#include <cmath>

#include "pack/checks.hpp"

namespace sinew::pack {
namespace {

// Both roots of z^2 = a1 z + a2 lie inside the unit circle (Jury). False for NaN.
bool is_stable(float a1, float a2) noexcept { return a2 > -1 && std::fabs(a1) < 1 - a2; }

Status check_mode(const ModeRecord& mode, size_t index) noexcept {
  if (!is_positive(mode.rad_per_s)) return corrupt("mode %zu: %g rad/s", index, double{mode.rad_per_s});
  if (!std::isfinite(mode.damping_ratio) || mode.damping_ratio < 0)
    return corrupt("mode %zu: damping ratio %g", index, double{mode.damping_ratio});
  if (!is_stable(mode.a1, mode.a2))
    return corrupt("mode %zu: its recurrence %g, %g grows", index, double{mode.a1}, double{mode.a2});
  if (!std::isfinite(mode.gain)) return corrupt("mode %zu: gain is not finite", index);
  return check_zero(mode.reserved, "mode", index);
}

Status check_record(const PackView& pack, const RegionModesRecord& modes, size_t index) noexcept {
  if (modes.mode_count > kMaxModes)
    return corrupt("region modes %zu: %u modes, outside 0..64", index, modes.mode_count);
  if (modes.padded != round_up_16(uint64_t{3} * pack.regions[index].node_count))
    return corrupt("region modes %zu: nodes padded to %u", index, modes.padded);
  if (!is_positive(modes.first_rad_per_s))
    return corrupt("region modes %zu: first mode at %g rad/s", index, double{modes.first_rad_per_s});
  if (!is_stable(modes.rest_a1, modes.rest_a2))
    return corrupt("region modes %zu: the rest's recurrence %g, %g grows", index, double{modes.rest_a1},
                   double{modes.rest_a2});
  if (!std::isfinite(modes.rest_gain)) return corrupt("region modes %zu: rest_gain is not finite", index);
  if (!is_stable(modes.first_a1, modes.first_a2))
    return corrupt("region modes %zu: the first mode's recurrence %g, %g grows", index,
                   double{modes.first_a1}, double{modes.first_a2});
  return check_zero(modes.reserved, "region modes", index);
}

uint64_t numbers_of(const PackView& pack, size_t index) noexcept {
  return uint64_t{3} * pack.regions[index].node_count;
}

// shape and turn; response; project.
uint64_t floats_of(const PackView& pack, const RegionModesRecord& modes, size_t index) noexcept {
  const uint64_t padded_modes = round_up_16(modes.mode_count);
  return uint64_t{2} * modes.mode_count * modes.padded +
         numbers_of(pack, index) * (modes.padded + 2 * padded_modes);
}

bool is_padded_with_zeros(std::span<const float> row, size_t used) noexcept {
  return std::ranges::all_of(row.subspan(used), [](float v) { return v == 0; });
}

bool has_zero_padding(const PackView& pack, const RegionModesRecord& modes, size_t index) noexcept {
  const size_t numbers = numbers_of(pack, index), padded_modes = round_up_16(modes.mode_count);
  auto rest = pack.mode_matrices.subspan(modes.matrices);
  const auto next_row_is_padded = [&](size_t padded, size_t used) {
    const auto row = rest.first(padded);
    rest = rest.subspan(padded);
    return is_padded_with_zeros(row, used);
  };
  bool good = true;
  for (uint32_t k = 0; k < 2 * modes.mode_count; ++k) good &= next_row_is_padded(modes.padded, numbers);
  for (size_t i = 0; i < numbers; ++i) {
    good &= next_row_is_padded(modes.padded, numbers);
    good &= next_row_is_padded(padded_modes, modes.mode_count);
  }
  for (size_t i = 0; i < numbers; ++i) good &= next_row_is_padded(padded_modes, modes.mode_count);
  return good;
}

Status check_matrices(const PackView& pack, const RegionModesRecord& modes, size_t index) noexcept {
  const auto values = pack.mode_matrices.subspan(modes.matrices, floats_of(pack, modes, index));
  if (first_not_finite(values) != values.size())
    return corrupt("region modes %zu: a number of a matrix is not finite", index);
  if (!has_zero_padding(pack, modes, index))
    return corrupt("region modes %zu: padding of a matrix is not zero", index);
  return {};
}

Status check_regions(const PackView& pack) noexcept {
  uint64_t mode = 0, matrices = 0;
  for (size_t index = 0; index < pack.region_modes.size(); ++index) {
    const RegionModesRecord& modes = pack.region_modes[index];
    if (Status status = check_record(pack, modes, index); !status.ok()) return status;
    const uint64_t floats = floats_of(pack, modes, index);
    if (modes.first_mode != mode || modes.mode_count > pack.modes.size() - mode)
      return corrupt("region modes %zu: modes do not follow the region before it", index);
    if (modes.matrices != matrices || floats > pack.mode_matrices.size() - matrices)
      return corrupt("region modes %zu: matrices do not follow the region before it", index);
    if (Status status = check_matrices(pack, modes, index); !status.ok()) return status;
    mode += modes.mode_count;
    matrices += floats;
  }
  const bool whole = mode == pack.modes.size() && matrices == pack.mode_matrices.size();
  return whole ? Status{} : corrupt("region modes: modes or matrices that no region owns");
}

Status check_each_mode(const PackView& pack) noexcept {
  for (size_t index = 0; index < pack.modes.size(); ++index)
    if (Status status = check_mode(pack.modes[index], index); !status.ok()) return status;
  return {};
}

}  // namespace

Status check_modes(const PackView& pack) noexcept {
  constexpr Check kChecks[] = {check_each_mode, check_regions};
  return run_checks(kChecks, pack);
}

}  // namespace sinew::pack

// check_modes.cpp  Modal bases agree with the regions, and none of them can grow.
#include <algorithm>
#include <cmath>

#include "pack/checks/checks.hpp"

namespace sinew::pack {
namespace {

// Both roots of z^2 = a1 z + a2 lie inside the unit circle (Jury). False for NaN.
bool is_stable(float a1, float a2) noexcept { return a2 > -1 && std::fabs(a1) < 1 - a2; }

constexpr float kSlowest_rad_per_s = 1e-2f, kFastest_rad_per_s = 1e6f, kMostDampingRatio = 1e6f;
// Of a matrix, whose scale is that of its modes: what is multiplied with each other is bounded by
// kMostAnswer.
constexpr float kMostNumber = 1e9f;
// What a unit of force or displacement brings, of the latter; a part that is free but for 1e-2 rad/s: 1e4
// s^2.
constexpr double kMostAnswer = 1e6;

// A gain is what brings a lasting force's displacement, 1 / w^2; both sides have been rounded, a1 near 2 by
// up to 1.2e-7.
bool is_gain(double gain, double of, float a1, float a2) noexcept {
  constexpr double kRounding = 5e-7;
  const double wanted = 1 - double{a1} - double{a2};
  return std::fabs(gain * of - wanted) <= kRounding + 1e-2 * wanted;
}

Status check_mode(const ModeRecord& mode, size_t index) noexcept {
  if (!is_within(mode.rad_per_s, kSlowest_rad_per_s, kFastest_rad_per_s))
    return corrupt("mode %zu: %g rad/s, outside 1e-2..1e6", index, double{mode.rad_per_s});
  if (!is_within(mode.damping_ratio, 0, kMostDampingRatio))
    return corrupt("mode %zu: damping ratio %g", index, double{mode.damping_ratio});
  if (!is_stable(mode.a1, mode.a2))
    return corrupt("mode %zu: its recurrence %g, %g grows", index, double{mode.a1}, double{mode.a2});
  if (!is_gain(double{mode.gain}, double{mode.rad_per_s} * double{mode.rad_per_s}, mode.a1, mode.a2))
    return corrupt("mode %zu: gain %g is not that of its recurrence", index, double{mode.gain});
  return check_zero(mode.reserved, "mode", index);
}

Status check_record(const PackView& pack, const RegionModesRecord& modes, size_t index) noexcept {
  if (modes.mode_count > kMaxModes)
    return corrupt("region modes %zu: %u modes, outside 0..64", index, modes.mode_count);
  if (modes.padded != round_up_16(uint64_t{3} * pack.regions[index].node_count))
    return corrupt("region modes %zu: nodes padded to %u", index, modes.padded);
  if (!is_within(modes.first_rad_per_s, kSlowest_rad_per_s, kFastest_rad_per_s))
    return corrupt("region modes %zu: first mode at %g rad/s, outside 1e-2..1e6", index,
                   double{modes.first_rad_per_s});
  if (!is_stable(modes.rest_a1, modes.rest_a2))
    return corrupt("region modes %zu: the rest's recurrence %g, %g grows", index, double{modes.rest_a1},
                   double{modes.rest_a2});
  if (!is_gain(double{modes.rest_gain}, 1, modes.rest_a1, modes.rest_a2))
    return corrupt("region modes %zu: rest_gain %g is not that of its recurrence", index,
                   double{modes.rest_gain});
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

double largest(std::span<const float> values) noexcept {
  float most = 0;
  for (const float v : values) most = std::max(most, std::fabs(v));
  return double{most};
}

// The largest number of what a force on one number brings, through the modes and beside them, and of what
// taking a displacement apart into modes and putting it together again makes of a unit.
double most_answer(const PackView& pack, const RegionModesRecord& modes, size_t index) noexcept {
  const size_t numbers = numbers_of(pack, index), padded_modes = round_up_16(modes.mode_count);
  const auto all = pack.mode_matrices.subspan(modes.matrices);
  const auto response = all.subspan(size_t{2} * modes.mode_count * modes.padded);
  const auto project = response.subspan(numbers * (modes.padded + padded_modes));
  double most = 0;
  for (uint32_t k = 0; k < modes.mode_count; ++k) {
    const double shape = largest(all.subspan(size_t{k} * modes.padded, modes.padded)),
                 turn = largest(all.subspan((size_t{modes.mode_count} + k) * modes.padded, modes.padded)),
                 moves = std::max(shape, turn), w = double{pack.modes[modes.first_mode + k].rad_per_s};
    for (size_t i = 0; i < numbers; ++i) {
      const float force = response[i * (modes.padded + padded_modes) + modes.padded + k];
      most = std::max({most, moves * std::fabs(double{force}) / (w * w),
                       moves * std::fabs(double{project[i * padded_modes + k]})});
    }
  }
  for (size_t i = 0; i < numbers; ++i)
    most = std::max(most, largest(response.subspan(i * (modes.padded + padded_modes), modes.padded)));
  return most;
}

Status check_matrices(const PackView& pack, const RegionModesRecord& modes, size_t index) noexcept {
  const auto values = pack.mode_matrices.subspan(modes.matrices, floats_of(pack, modes, index));
  if (!are_within(values, kMostNumber))
    return corrupt("region modes %zu: a number of a matrix is not within +-1e9", index);
  if (!(most_answer(pack, modes, index) <= kMostAnswer))
    return corrupt("region modes %zu: its matrices amplify their input more than 1e6 times", index);
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

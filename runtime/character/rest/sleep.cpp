// sleep.cpp  see sleep.hpp.
#include "character/rest/sleep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/correction_budget.hpp"

namespace sinew::world {
namespace {

struct Region {
  const pack::RegionRecord& record;
  float w1, w1_tick, rest_m;  // rad/s, rad a tick, metres
};

Region region_at(const Instance& instance, size_t index, float tolerance) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const float w1 = first_rad_per_s(instance, index);
  return {pack.regions[index], w1, w1 * static_cast<float>(instance.asset->tick_s),
          tolerance * pack.regions[index].radius_m};
}

// By compare, so that NaN is never near.
bool is_near(const float* a, const float* b, float distance) noexcept {
  float squared = 0;
  for (int k = 0; k < 3; ++k) squared += (a[k] - b[k]) * (a[k] - b[k]);
  return squared <= distance * distance;
}

bool feels_the_same(const TissueState& tissue, const Region& region, const FeltNodes& felt) noexcept {
  const float most = region.rest_m * region.w1 * region.w1;
  const float* asleep = tissue.felt_asleep + size_t{3} * region.record.first_node;
  for (uint32_t n = 0; n < region.record.node_count; ++n) {
    const float* at = felt.first + felt.stride * n;
    const float now[3] = {felt.times * at[0], felt.times * at[1], felt.times * at[2]};
    if (!is_near(now, asleep + size_t{3} * n, most)) return false;
  }
  return true;
}

void remember_drive(TissueState& tissue, const Region& region) noexcept {
  for (size_t n = region.record.first_node; n < region.record.first_node + region.record.node_count; ++n)
    std::copy_n(tissue.drive + tissue::kNodeDriveWidth * n, 3, tissue.felt_asleep + 3 * n);
}

bool stays(const TissueState& tissue, const Region& region) noexcept {
  const float most = region.rest_m * region.w1_tick;
  for (size_t n = region.record.first_node; n < region.record.first_node + region.record.node_count; ++n) {
    if (!is_near(tissue.l[0] + 3 * n, tissue.l[1] + 3 * n, most)) return false;
  }
  return true;
}

template <class Work>
void for_each_region(Instance& instance, float tolerance, Work work) noexcept {
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r)
    work(r, region_at(instance, r, tolerance), instance.tissue.quiet_ticks[r]);
}

// Nothing of the last tick is left to go on with; the budget covers what corrections there are.
void stop_region(Instance& instance, size_t region) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const pack::RegionModesRecord& modes = pack.region_modes[region];
  const size_t vector = size_t{3} * pack.regions[region].first_node,
               floats = size_t{3} * pack.regions[region].node_count;
  std::copy_n(instance.tissue.q[0] + modes.first_mode, modes.mode_count,
              instance.tissue.q[1] + modes.first_mode);
  std::copy_n(instance.tissue.corrected[0] + modes.first_mode, modes.mode_count,
              instance.tissue.corrected[1] + modes.first_mode);
  float squared = 0;
  for (uint32_t m = 0; m < modes.mode_count; ++m)
    squared += instance.tissue.corrected[0][modes.first_mode + m] *
               instance.tissue.corrected[0][modes.first_mode + m];
  instance.tissue.swing[region] = squared / (tissue::kMostCorrection * tissue::kMostCorrection);
  for (float* const* ticks : {instance.tissue.r, instance.tissue.u})
    std::copy_n(ticks[0] + vector, floats, ticks[1] + vector);
}

void fall_asleep(Instance& instance, size_t index, const Region& region) noexcept {
  const size_t vector = size_t{3} * region.record.first_node;
  stop_region(instance, index);
  std::copy_n(instance.tissue.l[0] + vector, size_t{3} * region.record.node_count,
              instance.tissue.l[1] + vector);
}

}  // namespace

bool feels_as_asleep(const Instance& instance, size_t region, const FeltNodes& felt) noexcept {
  return feels_the_same(instance.tissue, region_at(instance, region, instance.parameters.sleep_tolerance),
                        felt);
}

void watch_drive(Instance& instance) noexcept {
  for_each_region(instance, instance.parameters.sleep_tolerance,
                  [&](size_t, const Region& region, uint32_t& quiet_ticks) {
                    const FeltNodes felt{
                        instance.tissue.drive + size_t{tissue::kNodeDriveWidth} * region.record.first_node,
                        tissue::kNodeDriveWidth};
                    if (quiet_ticks > 0 && feels_the_same(instance.tissue, region, felt)) return;
                    quiet_ticks = 0;
                    remember_drive(instance.tissue, region);
                  });
}

void watch_motion(Instance& instance) noexcept {
  if (!frame::is_simulated(instance.state->tier)) return;
  const float tolerance = instance.parameters.sleep_tolerance;
  for_each_region(instance, tolerance, [&](size_t r, const Region& region, uint32_t& quiet_ticks) {
    const uint32_t enough = ticks_to_sleep(instance, r);
    if (quiet_ticks >= enough) return;
    const bool quiet = tolerance > 0 && stays(instance.tissue, region);
    quiet_ticks = quiet ? quiet_ticks + 1 : 0;
    if (quiet_ticks >= enough) fall_asleep(instance, r, region);
  });
}

}  // namespace sinew::world

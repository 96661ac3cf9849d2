// parameter_state.cpp  see parameter_state.hpp.
#include "character/parameters/parameter_state.hpp"

#include <memory>

namespace sinew::world {

void lay_out_state(const Asset& asset, core::Arena& arena, ParameterState& to) noexcept {
  to.region_tunings = arena.take<PartTuning>(asset.pack.regions.size());
  to.rod_tunings = arena.take<PartTuning>(asset.rods.rod_count);
}

void lay_out_scratch(const Asset& asset, core::Arena& arena, ParameterState& to) noexcept {
  to.tuned_modes = arena.take<pack::ModeRecord>(asset.mode_count());
  to.tuned_slopes = arena.take<tissue::SwingSlopes>(asset.mode_count() + asset.pack.regions.size());
  to.tuned_regions = arena.take<TunedRegion>(asset.pack.regions.size());
}

void begin(const Asset& asset, ParameterState& to) noexcept {
  to.sleep_tolerance = WorldDef{}.sleep_tolerance;
  to.most_m_s2 = TeleportDef{}.acceleration * asset.pack.character->height_m;
  std::uninitialized_fill_n(to.region_tunings, asset.pack.regions.size(), PartTuning());
  std::uninitialized_fill_n(to.rod_tunings, asset.rods.rod_count, PartTuning());
  std::uninitialized_fill_n(to.tuned_regions, asset.pack.regions.size(), TunedRegion());
}

}  // namespace sinew::world

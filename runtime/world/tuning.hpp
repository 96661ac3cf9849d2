// tuning.hpp  How parts swing, as an engine changes it between steps (sinew/parameters.hpp).
//
// Every number of a part goes to what was set as a critically damped spring does (world/glide.hpp): 5 % of
// the way are left after 12 ticks. Stiffness, in its logarithm, and displacement, in its root, go no faster
// than world/tuning.cpp says. A tick runs with the numbers that the end of the last one foretold, so frames
// between ticks know what the coming tick will have, and a call between steps moves nothing by itself.
//   stiffness, damping   change the recurrences of a part's modes (tissue/retuned.hpp), and a rod's joints
//                        (RodBatch::set_joint); q, r and l go on from where they are
//   intensity            scales what is shown, and a rod's turns; what swings is not scaled
//   displacement         scales the guard's limit
//   off                  a part that is disabled and has faded sleeps until it is enabled, and then begins at
//                        rest under its load, unseen at first
// A network corrects a part by less the further its stiffness and damping are from the baked ones, and by
// nothing from a quarter on. The bound of tissue/correction_budget.hpp is of recurrences that stay: while
// they glide S may rise above it by what the change itself does; no correction is taken while it is above,
// and S falls at the modes' pace.
#pragma once
#include "tissue/modal_base.hpp"
#include "tissue/retuned.hpp"
#include "world/instance.hpp"

namespace sinew::world {

// A region's recurrences beside its modes', where they are not the baked ones. Made from the state.
struct TunedRegion {
  bool on = false;
  float stiffens = 0;  // what its modes were made with
  tissue::Recurrence rest, first;
  float rest_gain = 0;
};

inline bool tunes_parts(const Instance& instance) noexcept {
  return (instance.state->tuned & kTunedParts) != 0;
}

// ---- setting ----

// After one of the instance's SetParameters was changed, or all_parameters.
void notice_parameters(Instance& instance) noexcept;

// ---- in a step ----

// A tick begins: it has what was foretold. Before its motion is followed.
void begin_tuned_tick(Instance& instance) noexcept;
// It is over and shown: foretells the next.
void end_tuned_tick(Instance& instance) noexcept;
// At once as set, where nothing of it is simulated yet.
void settle_tuning(Instance& instance) noexcept;
// Makes anew what follows from the state: after a restore, a change of level.
void retune_all(Instance& instance) noexcept;
// Nothing is on its way and no gust blows.
inline bool tuning_stands(const Instance& instance) noexcept { return instance.state->tuning_moves == 0; }

// ---- what parts have ----

// A region's modes as its instance has them.
void tune_base(const Instance& instance, size_t region, tissue::ModalBase* base) noexcept;
inline tissue::ModalBase base_of(const Instance& instance, size_t region) noexcept {
  tissue::ModalBase base = tissue::modal_base(instance.level->pack, region);
  if (tunes_parts(instance)) tune_base(instance, region, &base);
  return base;
}
const tissue::SwingSlopes* slopes_of(const Instance& instance, size_t region) noexcept;
// Of w1: how what is left alone swings on.
tissue::Recurrence first_recurrence(const Instance& instance, size_t region) noexcept;
float first_rad_per_s(const Instance& instance, size_t region) noexcept;
// By a fraction of the coming tick.
float limit_m(const Instance& instance, size_t region, float x = 0) noexcept;
// What is shown, with its intensity, stays within that.
float shown_limit_m(const Instance& instance, size_t region) noexcept;
// Of what a network corrects.
float network_share(const Instance& instance, size_t region) noexcept;

bool region_is_off(const Instance& instance, size_t region) noexcept;
bool rods_are_off(const Instance& instance) noexcept;  // all of them
// Nothing of it is on.
bool all_is_off(const Instance& instance) noexcept;

// Nodes' vectors, by how much of them is shown.
float intensity_of(const Instance& instance, size_t region, float x = 0) noexcept;
void keep_intensity(const Instance& instance, float* shown, float x = 0) noexcept;
// The way back, of what was shown; what is hardly shown tells little of how it swings.
void take_out_intensity(const Instance& instance, float* shown) noexcept;

// How a rod is shown.
struct RodShown {
  float limit_rad;  // 0: none
  float intensity;
};
RodShown rod_shown(const Instance& instance, uint32_t rod, float x = 0) noexcept;
// What its joints' damping_s is multiplied with in the coming tick.
float rod_damping_share(const Instance& instance, uint32_t rod) noexcept;

// By how much further than Asset::reach_m what is shown may get.
float tuned_reach_m(const Instance& instance) noexcept;

}  // namespace sinew::world

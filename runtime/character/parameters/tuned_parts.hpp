// tuned_parts.hpp  What an instance's parts have of what an engine may change between steps
// (character/parameters/tuning.hpp), now or by a fraction x of the coming tick.
#pragma once
#include <cmath>

#include "character/instance.hpp"
#include "character/parameters/glide.hpp"
#include "tissue/modes/modal_base.hpp"
#include "tissue/modes/retuned.hpp"

namespace sinew::world {

inline bool tunes_parts(const Instance& instance) noexcept {
  return (instance.state->parameters.tuned & kTunedParts) != 0;
}

inline float displacement_of(const PartTuning& part, float x) noexcept {
  const float root = between(part.root_displacement, x);
  return root * root;
}

inline float stiffness_of(const PartTuning& part) noexcept {
  return static_cast<float>(std::exp(double{part.log_stiffness.next}));
}

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

}  // namespace sinew::world

// tissue_state.hpp  How an instance's soft parts swing: modes, what they leave out, a network's memory.
//
// Arrays are [nodes][3] in metres along each node's frame (tissue/frames/node_bend.hpp) unless said
// otherwise; l, theta and q as in tissue/modes/modal_base.hpp. u is what may be shown of l, within the
// region's limit (tissue/modes/guard.hpp).
#pragma once
#include <cstdint>

#include "character/asset/asset.hpp"
#include "core/arena.hpp"
#include "tissue/frames/fraction_step.hpp"
#include "tissue/network/network_weights.hpp"

namespace sinew::world {

// In ticks of the asset's rate.
// A network that missed at most so many ticks keeps its memory when it comes back; after more, its velocities
// are of another phase of the wobble and it starts anew from where it is.
inline constexpr uint32_t kRememberedTicks = 2;
// Over so many ticks the corrections of one without a memory rise to the whole.
inline constexpr uint16_t kNetworkBeginTicks = 8;
inline constexpr uint32_t kFallbackTicks = 60;  // on the modal base, after a network's state was given up

// Plain bytes, saved and restored as they are.
struct TissueCounters {
  uint32_t forgotten = 1;  // the network's state is no memory of this motion: a start, a guard
  uint32_t ticks_since_network = 0;
  uint32_t input_clamps = 0, displacement_clamps = 0, fallbacks = 0, restarts = 0;
  uint32_t untouched = 1;       // no tick since the first pose: displacement is exactly zero
  uint16_t network_begins = 0;  // ticks left in which a network without a memory corrects by less
  uint16_t is_off = 0;          // character/output/between_ticks.hpp
};

// What a tick of emulated patches is told and says, [nodes][3] in metres from the root's last tick
// (character/tissue/emulate.hpp); none without such regions.
struct EmulatorScratch {
  float *u_now = nullptr, *u_before = nullptr, *u_next = nullptr;
  float *x_now = nullptr, *x_before = nullptr, *x_next = nullptr;
  tissue::PatchView* views = nullptr;  // [nodes]
  float* l = nullptr;                  // as the network has it, along nodes' frames
  float* step = nullptr;               // of its kernels
};

struct TissueState {
  // State.
  float* network_memory = nullptr;
  float *u[2] = {}, *l[2] = {}, *theta = nullptr;  // newest first
  float *q[2] = {}, *r[2] = {};                    // q: [modes of all regions]
  // [modes]: by how much a network's corrections have moved q since it began, as modes go on with them.
  float* corrected[2] = {};
  float* swing = nullptr;           // [regions]: tissue/modes/correction_budget.hpp
  tissue::TickForce tick_force{};   // of the last tick
  float* felt_asleep = nullptr;     // m/s^2, when the region's quiet began (character/rest/sleep.hpp)
  uint32_t* quiet_ticks = nullptr;  // [regions]

  // Scratch of a step.
  float* drive = nullptr;  // [nodes][kNodeDriveWidth]
  EmulatorScratch emulator;
  float *felt = nullptr, *l_hat = nullptr, *r_hat = nullptr, *q_hat = nullptr, *carry = nullptr;
  float *inputs = nullptr, *network_scratch = nullptr;
  float* trust = nullptr;            // [regions]: tissue::trust_in of this tick
  float* region[2] = {};             // [widest_region]: one region's x y z and modes
  tissue::NodeRun* awake = nullptr;  // [regions]
};

void lay_out_state(const Asset& asset, core::Arena& arena, TissueState& to) noexcept;
void lay_out_scratch(const Asset& asset, core::Arena& arena, TissueState& to) noexcept;

}  // namespace sinew::world

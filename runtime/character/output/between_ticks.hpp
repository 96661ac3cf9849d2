// between_ticks.hpp  What is shown between two ticks: a provisional step of the last tick's state to the time
// of the frame, under the pose of the frame, which changes nothing of that state.
//
// Soft parts take the fraction of the tick that tissue/frames/fraction_step.hpp describes: where the pose's
// path has a slope, place and velocity go on through ticks, without a tick of latency. What the last tick
// added to the base's answer, a network's correction or the push of what is touched, is taken to be added
// again; by how much another one came fades within the tick, where there are frames in it. What sleeps on
// stays as it is, what teleported since the last tick goes on as it went, and what is not simulated as its
// tail will (character/transition/blend.hpp). A frame that ends on a tick shows the tick's own state and
// costs nothing more; of frames shorter than a fifth of a tick, where `off` is shown, it costs as one between
// ticks.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// After a tick: what it added to the base's answer. goes_on: from the tick before, of whose fractions frames
// shorter than a tick were shown.
void hold_added(Instance& instance, bool goes_on) noexcept;

// Along the axes of the flesh, [nodes][3], at the end of the last step, held within the regions' limits as a
// tick's displacement is; of what is not simulated, the tail before it fades. Where the step ended on a tick,
// the tick's own.
const float* shown_now(Instance& instance) noexcept;

}  // namespace sinew::world

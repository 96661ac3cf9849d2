// roll_out.hpp  A network run over reference vectors, its own output fed back, and how far it is from them.
#pragma once
#include <cstddef>
#include <functional>

#include "baker/common/files/safetensors.hpp"
#include "baker/measure/network/reference_vectors.hpp"
#include "baker/pack/network/graph.hpp"
#include "baker/research/precision/reduced_network.hpp"
#include "rods/start/coping_net.hpp"
#include "tissue/network/deep_emulator.hpp"
#include "tissue/network/network.hpp"

namespace sinew::baker {

// Vectors of the paper's wiring: edges (m,2), x (T+1,n,3), y0 (n,3), y (T,n,3), final.{l}.{h,c,y} (n,F).
// Vectors of stated inputs: edges (m,2), z (T,n,input_width) with the columns of displacement and velocity
// zero, y0 (n,3), y (T,n,3) in length units, and of a network closed on the modal base carry (T,n,3), what
// the base adds to y. Displacement of step t is y_{t-1}, velocity y_{t-1} - y_{t-2}, y_{-1} = y_0. A result
// that is not finite is an infinite error. Throws BadInput: vectors of another model, wiring or shape.
// after_step, where given, sees the graph's rows and the state behind each step.
using AfterStep = std::function<void(const GraphRows& graph, float* state)>;
RollOutError roll_out(const tissue::Network& network, const Safetensors& vectors,
                      const AfterStep& after_step = {});
RollOutError roll_out(const ReducedNetwork& network, const Safetensors& vectors);

// edges (m,2) undirected, x (T+3,n,3), material (n,3), constrained (n), u_1, u_0, u_m1 (n,3), y (T,n,3): step
// t, from 1, reads x[t+1], x[t], x[t-1] and the last three dynamic frames, at first u_1, u_0, u_m1, and gives
// y[t-1]. Of weights that see patches go on, no u_m1, but axes (T,9), by which they are seen in each step.
// Throws as roll_out does.
RollOutError roll_out_deep_emulator(const tissue::DeepEmulator& network, bool moving,
                                    const Safetensors& vectors);

// nodes (n,14), edges (m,5), senders, receivers (m), dp (n,6), dlambda (m,6): one evaluation. Throws as
// roll_out does.
RollOutError evaluate_coping_net(const rods::CopingNet& network, const Safetensors& vectors);

}  // namespace sinew::baker

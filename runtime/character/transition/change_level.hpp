// change_level.hpp  An instance goes on on another control graph of its asset.
//
// Levels have the same regions, modes and frames, and a coarser level's nodes are nodes of the finer one
// (pack::LevelRecord). One level at a time:
//   coarser  each node keeps what it had: u, l, r, theta, poses, network's memory
//   finer    q stays. With S how a coarser level spreads over a finer one (kSpread), of both ticks:
//            r = S r,  l = shape q + S (l - shape q before),  theta and u as in tissue/modes/modal_base.hpp.
//            Past poses are the new nodes' own, along the path of the pose. A node remembers
//            of the network what the coarser node did that carries most of it
//   left out a region that a level has no nodes for is forgotten there. Where it is had again it begins at
//   rest
//            under what the tick hears, with no memory, and is blended in as the seam fades
//   shown    the tail is picked, or spread; what is shown follows from it and u. What the surface differs by
//            then is its *seam*: added to what is carried, vertex by vertex, and faded out in kBlendInTicks
// So no vertex moves by the change itself, however often; from there on levels part by what they hear.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

// To a level of its asset, before a step in which it is simulated.
void change_level(Instance& instance, uint32_t level) noexcept;

// In the first tick of what begins at rest. moved: by how much u of the newer tick is to move, [nodes][3].
void settle_rest(Instance& instance, const float* moved) noexcept;

// TransitionState::level_scratch.
void lay_out_scratch(const Asset& asset, core::Arena& arena, TransitionState& to) noexcept;

}  // namespace sinew::world

// contact_response.hpp  A soft part held off by half-spaces: the forces that do it, within the tick.
//
// A node's contact says n . (l - l_free) >= -gap, n along l. What an acceleration e felt by one node brings
// in one tick is a row of the region's response, so the forces are those of the modal base's own tick:
//   A_ij = n_i . (shape gain force + rest_gain rest) n_j,   0 <= p  and  gap + A p >= 0, of each pair one is
//   0
// by projected Gauss-Seidel (Jourdan, Alart, Jean 1998). q, r and l are then what they had been had the nodes
// felt e = n p as well: the push is heard by every mode, has no velocity of its own, and what rests on
// something stands still.
#pragma once
#include <cstdint>
#include <span>

#include "tissue/modes/modal_base.hpp"

namespace sinew::tissue {

inline constexpr uint32_t kMostNodeContacts = 64;  // of a region

struct NodeContact {
  uint32_t node = 0;     // of the region
  float normal[3] = {};  // unit, along l: out of what is touched
  float gap_m = 0;       // where the node is when nothing presses; negative: by so much it is to move
  float press = 0;       // m/s^2 along the normal, 0 or more: the answer
};

// Where a tick has brought a region. q: [modes]; r, l, theta, u: [node_count][3].
struct ModalTick {
  float *q, *r, *l, *theta, *u;
};

// Finds the forces of at most kMostNodeContacts contacts of different nodes, and takes q, r, l, theta and u
// on by them; no node by more than most_m (0 or more): what does not yield by that is left inside. felt:
// [node_count][3], written over; scratch: [padded + padded_modes], answer: [padded]; all 64-byte aligned.
// False: without gaps below zero nothing changes. Cost: a response row each contact and a small matrix.
bool press(const ModalBase& base, float most_m, std::span<NodeContact> contacts, float* felt, float* scratch,
           float* answer, const ModalTick& tick) noexcept;

}  // namespace sinew::tissue

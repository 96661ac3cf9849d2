// lay_out.hpp  Where the arrays of an instance lie in its one block of memory.
#pragma once
#include "character/instance.hpp"
#include "core/arena.hpp"

namespace sinew::world {

// Points all arrays of `to`, by its contacts, into the arena: first what is saved, then scratch.
void lay_out(const Asset& asset, core::Arena& arena, Instance& to) noexcept;

}  // namespace sinew::world

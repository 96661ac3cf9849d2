// lay_out.cpp  see lay_out.hpp.
#include "character/life/lay_out.hpp"

#include "character/transition/change_level.hpp"

namespace sinew::world {

void lay_out(const Asset& asset, core::Arena& arena, Instance& to) noexcept {
  to.state = arena.take<InstanceState>(1);
  lay_out_state(asset, arena, to.motion);
  lay_out_state(asset, arena, to.tissue);
  lay_out_state(asset, arena, to.transition);
  lay_out_state(asset, arena, to.rods);
  lay_out_state(asset, arena, to.contacts);
  lay_out_state(asset, arena, to.parameters);
  to.state_bytes = arena.used_bytes();
  lay_out_scratch(asset, arena, to.motion);
  lay_out_scratch(asset, arena, to.tissue);
  lay_out_scratch(asset, arena, to.transition);
  lay_out_scratch(asset, arena, to.rods);
  lay_out_scratch(asset, arena, to.contacts);
  lay_out_scratch(asset, arena, to.parameters);
  lay_out_scratch(asset, arena, to.published);
}

}  // namespace sinew::world

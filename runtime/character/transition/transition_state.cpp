// transition_state.cpp  see transition_state.hpp.
#include "character/transition/transition_state.hpp"

namespace sinew::world {

void lay_out_state(const Asset& asset, core::Arena& arena, TransitionState& to) noexcept {
  const size_t vectors = size_t{3} * asset.node_count();
  to.tail = arena.take<float>(vectors);
  to.tail_velocity = arena.take<float>(vectors);
  for (float*& shown : to.shown) shown = arena.take<float>(vectors);
  to.regained = arena.take<uint32_t>(asset.pack.regions.size());
  if (asset.level_count > 1) to.seam = arena.take<float>(size_t{3} * asset.padded_vertices);
}

}  // namespace sinew::world

// published.cpp  see published.hpp.
#include "character/output/published.hpp"

namespace sinew::world {

void lay_out_scratch(const Asset& asset, core::Arena& arena, Published& to) noexcept {
  for (float** vectors : {&to.shown_between, &to.delta})
    *vectors = arena.take<float>(size_t{3} * asset.node_count());
  to.carried = arena.take<float>(size_t{3} * asset.padded_vertices);
  for (float** vectors : {&to.surface, &to.areas})
    *vectors = arena.take<float>(size_t{3} * asset.vertex_count());
}

}  // namespace sinew::world

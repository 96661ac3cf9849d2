// contact_state.cpp  see contact_state.hpp.
#include "character/contacts/contact_state.hpp"

#include <algorithm>

namespace sinew::world {

bool touches_own_body(const Asset& asset, const ContactDef& contacts) noexcept {
  return contacts.own_body && asset.touchable != nullptr;
}

bool soft_parts_touch(const Asset& asset, const ContactDef& contacts) noexcept {
  return contacts.source || touches_own_body(asset, contacts);
}

void lay_out_state(const Asset& asset, core::Arena& arena, ContactState& to) noexcept {
  if (to.def.own_body)
    for (double*& ends : to.proxy_ends) ends = arena.take<double>(6 * asset.pack.proxies.size());
  if (!soft_parts_touch(asset, to.def)) return;
  to.pushes = arena.take<float>(size_t{3} * asset.padded_vertices);
  to.pushed = arena.take<uint32_t>(asset.pack.regions.size());
  for (float*& skin : to.tick_skin) skin = arena.take<float>(size_t{12} * asset.pack.character->joint_count);
  for (float*& turn : to.tick_turn) turn = arena.take<float>(4);
}

void lay_out_scratch(const Asset& asset, core::Arena& arena, ContactState& to) noexcept {
  if (!soft_parts_touch(asset, to.def)) return;
  to.probes = arena.take<ContactProbe>(kProbesAtOnce);
  to.hits = arena.take<ContactHit>(kHitsAtOnce * (touches_own_body(asset, to.def) ? 2 : 1));
  uint32_t vertices = 0;
  for (const GraphLevel& level : asset.levels) vertices = std::max(vertices, level.patches.vertex_count);
  to.touches = arena.take<Touch>(size_t{2} * vertices);
  to.flesh = arena.take<float>(size_t{3} * asset.node_count());
  to.touched = arena.take<uint8_t>(vertices);
  to.deepest = arena.take<uint32_t>(asset.node_count());
  to.carries_pushes = arena.take<uint8_t>(asset.pack.regions.size());
  if (touches_own_body(asset, to.def)) to.proxy_before = arena.take<double>(6 * asset.pack.proxies.size());
}

}  // namespace sinew::world

// tissue_contacts.cpp  see tissue_contacts.hpp.
#include "character/contacts/tissue_contacts.hpp"

#include "character/contacts/find_touches.hpp"
#include "character/contacts/press_region.hpp"
#include "tissue/frames/node_bend.hpp"

namespace sinew::world {

void touch_tissue(Instance& instance) noexcept {
  const bool asks_source = instance.contacts.source && instance.contacts.tissue;
  if (!asks_source && !instance.proxy_before) return;
  tissue::along_flesh(instance.poses[0], instance.u[0], instance.level->node_count(), instance.flesh);
  instance.touched_moves_m = 0;
  for (uint32_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const uint32_t first = instance.touch_count;
    find_touches(instance, r);
    if (instance.touch_count > first)
      press_region(instance, r, {instance.touches + first, instance.touch_count - first});
  }
}

}  // namespace sinew::world

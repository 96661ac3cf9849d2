// tissue_contacts.cpp  see tissue_contacts.hpp.
#include "character/contacts/tissue_contacts.hpp"

#include "character/contacts/find_touches.hpp"
#include "character/contacts/press_region.hpp"
#include "tissue/frames/node_bend.hpp"

namespace sinew::world {

void touch_tissue(Instance& instance) noexcept {
  const bool asks_source = instance.contacts.def.source && instance.contacts.def.tissue;
  if (!asks_source && !instance.contacts.proxy_before) return;
  tissue::along_flesh(instance.motion.poses[0], instance.tissue.u[0], instance.level->node_count(),
                      instance.contacts.flesh);
  instance.contacts.touched_moves_m = 0;
  for (uint32_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const uint32_t first = instance.contacts.touch_count;
    find_touches(instance, r);
    if (instance.contacts.touch_count > first)
      press_region(instance, r, {instance.contacts.touches + first, instance.contacts.touch_count - first});
  }
}

}  // namespace sinew::world

// rods_pack.hpp  Rods of a character to the sections that the runtime simulates them from.
#pragma once
#include "baker/mesh/rods/proxies.hpp"
#include "baker/mesh/rods/rods.hpp"
#include "baker/pack/pack_writer.hpp"

namespace sinew::baker {

// Sections kRods, kRodSegments and kJointRods; none of them without rods. has_network: what learned starts
// need is there too; without it they are continued.
void add_rods(const Character& character, const std::vector<Rod>& rods, bool has_network, PackWriter& pack);

// Section kProxies; none without proxies.
void add_proxies(const std::vector<Proxy>& proxies, PackWriter& pack);

}  // namespace sinew::baker

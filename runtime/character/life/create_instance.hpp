// create_instance.hpp  An instance in its bind pose, at rest.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

size_t instance_bytes(const Asset& asset) noexcept;  // without contacts
// kOutOfCapacity when memory is short.
Status make_instance(Asset& asset, const InstanceDef& def, Instance* out) noexcept;

}  // namespace sinew::world

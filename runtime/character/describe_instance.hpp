// describe_instance.hpp  An instance as its report tells of it.
#pragma once
#include "character/instance.hpp"

namespace sinew::world {

InstanceReport describe(const Instance& instance, InstanceId id) noexcept;

}  // namespace sinew::world

// check_parameters.hpp  Refuses numbers of sinew/parameters.hpp that are out of their range, by name.
#pragma once
#include "sinew/parameters.hpp"
#include "sinew/status.hpp"

namespace sinew::world {

// NaN: kNotFinite; out of range: kInvalidArgument. function: who was given it.
Status check_parameters(const char* function, const PartParameters& given) noexcept;
Status check_environment(const Environment& given) noexcept;
Status check_added(const AddedEnvironment& given) noexcept;

}  // namespace sinew::world

// check_batch.hpp  Which strands and settings make a batch.
#pragma once
#include <span>

#include "rods/rod_batch.hpp"

namespace sinew::rods {

// kInvalidArgument or kNotFinite with the strand, segment or setting and what to do about it: what
// check_strand refuses, strands of other shapes than the first, settings outside their range, no strand.
Status check_batch(std::span<const StrandDef> strands, const RodSettings& settings) noexcept;

}  // namespace sinew::rods

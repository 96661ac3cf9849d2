// rod_batches.hpp  An instance's rods as batches: one for each shape of its asset's rods.
#pragma once
#include <memory>

#include "character/asset/asset.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::world {

// Refused: a start that there is not, a learned one without a network, no iterations.
Status check_rod_start(const Asset& asset, const InstanceDef& def) noexcept;
// In the bind pose, after check_rod_start. Refused: no memory, rods whose numbers leave float's range in
// their own units; *out untouched.
Status make_rod_batches(const Asset& asset, const InstanceDef& def,
                        std::unique_ptr<rods::RodBatch[]>* out) noexcept;
size_t rod_batch_bytes(const Asset& asset) noexcept;  // as baked

}  // namespace sinew::world

// rod_batches.hpp  An instance's rods as batches: one for each shape of its asset's rods.
#pragma once
#include <memory>

#include "rods/rod_batch.hpp"
#include "world/asset.hpp"

namespace sinew::world {

// In the bind pose. Refused: no memory, rods whose numbers leave float's range in their own units, a learned
// start without a network; *out untouched.
Status make_rod_batches(const Asset& asset, const InstanceDef& def,
                        std::unique_ptr<rods::RodBatch[]>* out) noexcept;
size_t rod_batch_bytes(const Asset& asset) noexcept;  // as baked

}  // namespace sinew::world

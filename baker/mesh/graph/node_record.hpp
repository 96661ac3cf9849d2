// node_record.hpp  A control node as the runtime reads it.
#pragma once
#include "baker/mesh/graph/tissue_layout.hpp"
#include "pack/format.hpp"

namespace sinew::baker {

Vector3 unit_or_up(const Vector3& normal);
pack::SkinRecord skin_record(const Influences& influences);
pack::NodeRecord node_record(const ControlNode& node);

}  // namespace sinew::baker

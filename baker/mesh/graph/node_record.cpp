// node_record.cpp  A control node as the runtime reads it.
#include "baker/mesh/graph/node_record.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {

Vector3 unit_or_up(const Vector3& normal) {
  const double length = normal.norm();
  return length > 1e-12 && std::isfinite(length) ? Vector3(normal / length) : Vector3::UnitY();
}

pack::SkinRecord skin_record(const Influences& influences) {
  pack::SkinRecord record{};
  for (size_t k = 0; k < pack::kInfluences; ++k) {
    record.weight[k] = static_cast<float>(influences.weight[k]);
    record.joint[k] = record.weight[k] > 0 ? static_cast<uint16_t>(influences.joint[k]) : uint16_t{0};
  }
  return record;
}

pack::NodeRecord node_record(const ControlNode& node) {
  pack::NodeRecord record{};
  const Vector3 normal = unit_or_up(node.normal);
  for (int axis = 0; axis < 3; ++axis) {
    record.position_m[axis] = static_cast<float>(node.position[axis]);
    record.normal[axis] = static_cast<float>(normal[axis]);
  }
  record.stiffness = static_cast<float>(std::clamp(node.stiffness, 0.0, 1.0));
  record.region = static_cast<uint32_t>(node.region);
  record.skin = skin_record(node.skin);
  return record;
}

}  // namespace sinew::baker

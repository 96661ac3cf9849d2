// vrm_values.hpp  Values of a VRM extension, damaged or not.
#pragma once
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "baker/import/gltf/scene_graph.hpp"

namespace sinew::baker {

// Null where it is not there.
inline const tinygltf::Value& part(const tinygltf::Value& value, const char* key) {
  static const tinygltf::Value kNothing;
  return value.IsObject() && value.Has(key) ? value.Get(key) : kNothing;
}

inline std::vector<tinygltf::Value> list(const tinygltf::Value& value) {
  return value.IsArray() ? value.Get<tinygltf::Value::Array>() : std::vector<tinygltf::Value>{};
}

inline double number(const tinygltf::Value& value, double otherwise, double low, double high) {
  const double given = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  return std::isfinite(given) ? std::clamp(given, low, high) : otherwise;
}

// The graph's node that a file's index names; -1: none.
inline int node_of(const SceneGraph& graph, const tinygltf::Value& stated) {
  if (!stated.IsNumber()) return -1;
  const double index = stated.GetNumberAsDouble();
  if (!(index >= 0 && index < static_cast<double>(graph.node_of_file.size()))) return -1;
  return graph.node_of_file[static_cast<size_t>(index)];
}

// Both versions of VRM, where the file has them.
template <class Reader>
void read_vrm(const tinygltf::Model& model, Reader& reader) {
  if (const auto at = model.extensions.find("VRM"); at != model.extensions.end())
    reader.read_version_0(at->second);
  if (const auto at = model.extensions.find("VRMC_springBone"); at != model.extensions.end())
    reader.read_version_1(at->second);
}

}  // namespace sinew::baker

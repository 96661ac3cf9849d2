// skin_weights.hpp  JOINTS_n and WEIGHTS_n of a primitive made into influences.
#pragma once
#include "baker/import/gltf/accessor.hpp"
#include "baker/import/skeleton/joints.hpp"

namespace sinew::baker {

// One Influences a vertex: at most eight, descending, sum 1. What is mended is noted. Vertices without
// weights hang on instance.joint.
std::vector<Influences> read_influences(const tinygltf::Primitive& primitive, size_t vertex_count,
                                        const MeshInstance& instance, const Joints& joints,
                                        const AccessorReader& accessors, const std::string& where,
                                        Source& source);

}  // namespace sinew::baker

// spring_bones.hpp  Spring bones that a VRM file states, version 0 and 1.
#pragma once
#include <tiny_gltf.h>

#include "baker/import/character/character.hpp"
#include "baker/import/gltf/scene_graph.hpp"

namespace sinew::baker {

// Nodes of the graph that a file's springs move, whether joints or not; see read_spring_bones.
std::vector<bool> spring_nodes(const tinygltf::Model& model, const SceneGraph& graph);

// VRM 0: extensions.VRM.secondaryAnimation.boneGroups, each bone a root with all that hangs on it; a
// bone below another root is part of that one's tree, and a lone one has a tail of 7 cm. VRM 1:
// extensions.VRMC_springBone.springs, from the first to the last but one joint of each, which ends where the
// last one is; a spring of one joint is left out. What is damaged or names no
// joint of `joint_node` is left out with a note: springs are ornament.
std::vector<SpringBones> read_spring_bones(const tinygltf::Model& model, const SceneGraph& graph,
                                           const std::vector<int>& joint_node, Source& source);

// What those spring bones collide with. VRM 0: secondaryAnimation.colliderGroups, spheres. VRM 1:
// VRMC_springBone.colliders, spheres and capsules. What is damaged, has another shape or names no joint is
// left out with a note.
std::vector<BodyCollider> read_body_colliders(const tinygltf::Model& model, const SceneGraph& graph,
                                              const std::vector<int>& joint_node, Source& source);

}  // namespace sinew::baker

// joints.hpp  The joints of all skins as one list, and where meshes hang on it.
#pragma once
#include <tiny_gltf.h>

#include <vector>

#include "baker/import/gltf/accessor.hpp"
#include "baker/import/gltf/scene_graph.hpp"

namespace sinew::baker {

// A mesh as a node of the scene shows it.
struct MeshInstance {
  int node = 0;    // in SceneGraph::nodes
  int mesh = 0;    // file indices
  int skin = -1;   // -1: rigid on `joint`
  int joint = -1;  // rigid: its joint; skinned: what vertices without weights hang on
  Matrix4 bind_from_mesh = Matrix4::Identity();
  std::vector<double> morph_weights;  // of the shape that the file shows: the node's, else the mesh's
  bool in_joint_spaces = false;       // of a skin without binds: each vertex lies in its joints' own spaces
};

// Bind space here: each skin's mesh space carried into the scene (bind_pose.hpp), so that all meshes stand on
// one skeleton as they were bound to it, whatever space the exporter wrote them in.
struct Joints {
  std::vector<int> node;  // parents before children
  std::vector<int> parent;
  std::vector<Matrix4> inverse_bind;      // joint-from-bind
  std::vector<std::vector<int>> of_skin;  // the file's skin and joint of the skin -> joint
};

// Fills joint, bind_from_mesh and in_joint_spaces of the instances. Skins whose binds of a node agree to
// float precision share a joint. swinging: nodes that become joints, in a skin or not, if a mesh hangs on
// them. Throws BadInput: no skin, indices out of range, bind matrices that cannot be inverted.
Joints read_joints(const tinygltf::Model& model, const SceneGraph& graph, const AccessorReader& accessors,
                   const std::vector<bool>& swinging, Source& source, std::vector<MeshInstance>& instances);

// Meshes of the scene, in the order of the file's nodes. Throws BadInput where there is none.
std::vector<MeshInstance> find_meshes(const tinygltf::Model& model, const SceneGraph& graph, Source& source);

}  // namespace sinew::baker

// bind_pose.hpp  Where nodes and meshes stood in the scene when skins were bound to them, whatever frame the
// file was exported in.
#pragma once
#include <vector>

#include "baker/import/gltf/scene_graph.hpp"

namespace sinew::baker {

// A skin of the file.
struct SkinBinds {
  std::vector<int> nodes;             // of its joints, in SceneGraph::nodes
  std::vector<Matrix4> inverse_bind;  // joint-from-mesh
  int mesh_node = 0;                  // that shows a mesh with this skin
  // Without, vertices lie in their joints' own spaces, and the rest pose is the only shape there is.
  bool states_binds = false;
};

bool is_invertible(const Matrix4& matrix);

class BindPose {
 public:
  explicit BindPose(const SceneGraph& graph);

  // Whether the skin's root joint rests where it was bound, as far as the file tells: such a skin comes
  // first.
  bool rests_as_bound(const SkinBinds& skin) const;

  // Scene-from-mesh of a skin that states its binds; its joints are known from here on. By joints that are
  // known from other skins, so that skins stand as they do on one skeleton; else by the joint above; else by
  // the rest pose of the root joint, unless no frame that the mesh may have been modelled in is turned so:
  // then as the one that is turned most like it.
  Matrix4 add_skin(const SkinBinds& skin);
  // Joints of a skin without binds are bound where they rest, unless they are known.
  void add_resting_skin(const SkinBinds& skin);

  // Scene-from-node: as bound, below a bound node at rest relative to it, else at rest.
  Matrix4 of_node(int node) const;

 private:
  const Matrix4* known(int node) const;
  std::vector<Matrix4> likely_frames(const SkinBinds& skin, int root_joint) const;
  int root_of(const SkinBinds& skin) const;
  Matrix4 at_rest(const SkinBinds& skin, size_t joint) const;
  Matrix4 scene_from_mesh(const SkinBinds& skin) const;

  const SceneGraph& graph_;
  std::vector<bool> is_known_;
  std::vector<Matrix4> bound_;
};

}  // namespace sinew::baker

// describe_source.cpp  see describe_source.hpp.
#include "baker/programs/describe/describe_source.hpp"

#include <algorithm>

#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

using Json = nlohmann::ordered_json;

Json describe_bones(const Character& character) {
  std::vector<size_t> vertices(character.joint_node.size(), 0);
  for (const Influences& skin : character.skin) ++vertices[static_cast<size_t>(skin.joint[0])];
  const JointNames names(character);
  Json bones = Json::array();
  for (size_t j = 0; j < vertices.size(); ++j) {
    const int parent = character.joint_parent[j];
    bones.push_back({{"name", names.unique(j)},
                     {"parent", parent < 0 ? "-" : names.unique(static_cast<size_t>(parent))},
                     {"vertices", vertices[j]}});
  }
  return bones;
}

Json describe_meshes(const Character& character) {
  Json meshes = Json::array();
  for (const MeshSpan& mesh : character.meshes)
    meshes.push_back({{"name", character.nodes[static_cast<size_t>(mesh.node)].name},
                      {"vertices", mesh.vertex_count},
                      {"skinned", mesh.skinned}});
  return meshes;
}

Json describe_primitives(const Character& character) {
  Json primitives = Json::array();
  for (const PrimitiveSpan& primitive : character.primitives) {
    const auto node = static_cast<size_t>(character.meshes[primitive.mesh].node);
    primitives.push_back({{"mesh", character.nodes[node].name},
                          {"index", primitive.index},
                          {"material", primitive.material.empty() ? Json() : Json(primitive.material)},
                          {"vertices", primitive.vertex_count},
                          {"triangles", primitive.triangle_count}});
  }
  return primitives;
}

}  // namespace

Json describe_source(const Character& character) {
  Json clips = Json::array();
  for (const Clip& clip : character.clips)
    clips.push_back({{"name", clip.name}, {"seconds", clip.duration_s}});
  return {{"kind", "source"},
          {"character",
           {{"name", character.name}, {"height_m", height_m(character)}, {"unit_m", character.unit_m}}},
          {"bones", describe_bones(character)},
          {"meshes", describe_meshes(character)},
          {"primitives", describe_primitives(character)},
          {"clips", std::move(clips)}};
}

}  // namespace sinew::baker

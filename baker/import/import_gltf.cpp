// import_gltf.cpp  The steps from a file to a Character.
#include "baker/import/import_gltf.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <new>

#include "baker/import/gltf/gltf_file.hpp"
#include "baker/import/meshes/mesh_names.hpp"
#include "baker/import/meshes/primitives.hpp"
#include "baker/import/meshes/shown_meshes.hpp"
#include "baker/import/meshes/tangents.hpp"
#include "baker/import/meshes/weld.hpp"
#include "baker/import/skeleton/clips.hpp"
#include "baker/import/vrm/node_constraints.hpp"
#include "baker/import/vrm/spring_bones.hpp"

namespace sinew::baker {
namespace {

// Heights that are taken as metres without a word. A taller character was modelled in centimetres; a smaller
// one is imported as it is, and the doubt noted.
constexpr double kSmallestMetres = 0.05, kTallestMetres = 50;
constexpr double kLargestCoordinate = 1e7;

void check_options(const ImportOptions& options, const Source& source) {
  if (options.up != 'y' && options.up != 'z')
    source.refuse("option up", "is '" + std::string(1, options.up) + "'", "give y or z");
  if (!(options.unit_m >= 0) || !std::isfinite(options.unit_m))
    source.refuse("option unit_m", "is not a positive number",
                  "give metres a unit, 0.01 for centimetres, or 0 to guess");
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

Matrix4 upright(char up) {
  Matrix4 turn = Matrix4::Identity();
  if (up == 'z') turn.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

double height(const std::vector<Vector3>& positions) {
  double low = positions.front().y(), high = low;
  for (const Vector3& place : positions) low = std::min(low, place.y()), high = std::max(high, place.y());
  return high - low;
}

double unit_metres(double height, const ImportOptions& options, Source& source) {
  if (options.unit_m > 0) return options.unit_m;
  const double unit = height > kTallestMetres ? 0.01 : 1;
  if (unit != 1)
    source.note(
        "", rounded(height) + " units tall: taken as centimetres (unit_m states the unit if that is wrong)");
  else if (height < kSmallestMetres)
    source.note("",
                rounded(height) + " units tall: taken as metres (unit_m states the unit if that is wrong)");
  return unit;
}

// From bind space in the file's units and axes to the character's.
void convert_axes(const ImportOptions& options, Source& source, Character& character) {
  const Matrix4 turn = upright(options.up);
  if (options.up != 'y') source.note("", "turned from Z up to Y up");
  for (Vector3& place : character.positions) place = turn.topLeftCorner<3, 3>() * place;
  for (Vector3& normal : character.normals) normal = turn.topLeftCorner<3, 3>() * normal;
  for (Tangent& tangent : character.tangents) tangent.along = turn.topLeftCorner<3, 3>() * tangent.along;
  const double unit = unit_metres(height(character.positions), options, source);
  character.unit_m = unit;
  for (size_t v = 0; v < character.positions.size(); ++v) {
    character.positions[v] *= unit;
    if (!(character.positions[v].cwiseAbs().maxCoeff() < kLargestCoordinate))
      source.refuse("vertex " + std::to_string(v), "lies more than 10,000 km from the origin",
                    "mend the mesh, or state its unit by unit_m");
  }
  character.character_from_scene = turn;
  character.character_from_scene.topRows<3>() *= unit;
  const Matrix4 back = character.character_from_scene.inverse();
  for (Matrix4& bind : character.inverse_bind) bind = bind * back;
  for (MeshSpan& mesh : character.meshes) mesh.mesh_from_bind = mesh.mesh_from_bind * back;
  const auto convert = [&](SpringNumbers& numbers) {
    numbers.gravity_direction = turn.topLeftCorner<3, 3>() * numbers.gravity_direction;
    numbers.hit_radius_m *= unit;
  };
  for (SpringBones& spring : character.springs) {
    convert(spring.numbers);
    spring.tail_m *= unit;
    for (auto& [joint, numbers] : spring.of_joints) convert(numbers);
  }
}

// Copies that the extension asks for are not made.
void note_instancing(const tinygltf::Model& model, Source& source) {
  for (const tinygltf::Node& node : model.nodes)
    if (node.extensions.contains("EXT_mesh_gpu_instancing"))
      source.note("node '" + node.name + "'", "EXT_mesh_gpu_instancing is not followed: it is there once");
}

Character import_file(Source& source, const ImportOptions& options) {
  check_options(options, source);
  const tinygltf::Model model = read_gltf_file(source);
  const AccessorReader accessors(model, source);
  SceneGraph graph = read_scene_graph(model, source);
  std::vector<MeshInstance> instances = find_meshes(model, graph, source);
  leave_out_meshes(model, graph, options.without_meshes, source, instances);
  keep_shown_meshes(model, graph, options.with_meshes, source, instances);
  note_instancing(model, source);
  read_node_constraints(model, graph, source);
  Joints joints = read_joints(model, graph, accessors, spring_nodes(model, graph), source, instances);

  Character character;
  character.name = std::filesystem::path(source.path()).stem().string();
  const std::vector<Vector2> uv =
      append_meshes(model, accessors, joints, instances, options.max_vertices, source, character);
  if (character.positions.empty() || character.triangles.empty())
    source.refuse("", "no mesh of this file has triangles", "export the character's mesh as triangles");
  character.clips = read_clips(model, graph, accessors, source);
  character.springs = read_spring_bones(model, graph, joints.node, source);
  character.colliders = read_body_colliders(model, graph, joints.node, source);
  character.nodes = std::move(graph.nodes);
  character.joint_node = std::move(joints.node);
  character.joint_parent = std::move(joints.parent);
  character.inverse_bind = std::move(joints.inverse_bind);
  convert_axes(options, source, character);
  weld_vertices(character);
  drop_degenerate_triangles(character, source);
  compute_missing_normals(character);
  compute_missing_tangents(uv, character);
  return character;
}

}  // namespace

Character import_gltf(const std::string& path, const ImportOptions& options) {
  Source source(path);
  try {
    Character character = import_file(source, options);
    character.notes = source.notes();
    return character;
  } catch (const std::bad_alloc&) {
    source.refuse("", "needs more memory than there is", "reduce the file");
  }
}

}  // namespace sinew::baker

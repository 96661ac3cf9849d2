// primitives.cpp  Vertices and triangles of every primitive.
#include "baker/import/meshes/primitives.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "baker/common/bad_input.hpp"
#include "baker/import/color/base_color_texture.hpp"
#include "baker/import/color/surface_color.hpp"
#include "baker/import/meshes/paint.hpp"
#include "baker/import/meshes/skin_weights.hpp"
#include "baker/import/meshes/triangles.hpp"
#include "baker/import/skeleton/bind_pose.hpp"

namespace sinew::baker {
namespace {

constexpr const char* kMend = "the file is damaged; export it again";
constexpr size_t kMaxPrimitives = 65536;
constexpr size_t kMostTargets = 256;  // on each of the most vertices that there may be

// What primitives share vertices by.
using VertexKey = std::pair<std::map<std::string, int>, std::vector<std::map<std::string, int>>>;

VertexKey key_of(const tinygltf::Primitive& primitive) { return {primitive.attributes, primitive.targets}; }

bool is_morphed(const MeshInstance& instance) {
  return std::ranges::any_of(instance.morph_weights, [](double weight) { return weight != 0; });
}

// Bind-from-file of each vertex.
class VertexSpaces {
 public:
  VertexSpaces(const MeshInstance& instance, const std::vector<Matrix4>& bind_from_joint,
               const std::vector<Influences>& influences)
      : instance_(instance), influences_(influences), bind_from_joint_(bind_from_joint) {}

  Matrix4 of(size_t vertex) const {
    if (!instance_.in_joint_spaces) return instance_.bind_from_mesh;
    Matrix4 sum = Matrix4::Zero();
    const Influences& skin = influences_[vertex];
    for (size_t k = 0; k < kInfluences && skin.weight[k] > 0; ++k)
      sum += skin.weight[k] * bind_from_joint_[static_cast<size_t>(skin.joint[k])];
    return sum;
  }

 private:
  const MeshInstance& instance_;
  const std::vector<Influences>& influences_;
  const std::vector<Matrix4>& bind_from_joint_;
};

// A mesh that is hidden by a scale of zero has no way back.
Matrix4 inverse_or_identity(const Matrix4& matrix) {
  return is_invertible(matrix) ? Matrix4(matrix.inverse()) : Matrix4(Matrix4::Identity());
}

// Of directions that stay square to the surface: the cofactors, which a flattened space has, too.
Eigen::Matrix3d of_normals(const Matrix4& matrix) {
  const Eigen::Matrix3d m = matrix.topLeftCorner<3, 3>();
  Eigen::Matrix3d cofactors;
  for (int k = 0; k < 3; ++k)
    cofactors.col(k) = Vector3(m.col((k + 1) % 3)).cross(Vector3(m.col((k + 2) % 3)));
  return m.determinant() < 0 ? Eigen::Matrix3d(-cofactors) : cofactors;
}

class MeshReader {
 public:
  MeshReader(const tinygltf::Model& model, const AccessorReader& accessors, const Joints& joints,
             Source& source, Character& character)
      : model_(model),
        accessors_(accessors),
        joints_(joints),
        source_(source),
        character_(character),
        textures_(model) {
    for (const Matrix4& inverse_bind : joints.inverse_bind)
      bind_from_joint_.push_back(inverse_bind.inverse());
  }

  void append(const MeshInstance& instance) {
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<size_t>(instance.mesh)];
    std::map<VertexKey, int> owners;  // the primitive that has the vertices
    const size_t first = character_.positions.size(), first_primitive = character_.primitives.size();
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = mesh.primitives[p];
      const std::string where = place(instance, p);
      if (!usable(primitive, instance, where)) continue;
      PrimitiveSpan span{
          .mesh = character_.meshes.size(), .material = material_name(primitive.material), .index = p};
      const auto [owner, is_own] =
          owners.try_emplace(key_of(primitive), static_cast<int>(character_.primitives.size()));
      if (is_own)
        append_vertices(primitive, instance, where, span);
      else
        share_vertices(owner->second, span);
      append_faces(primitive, instance, where, span);
      character_.primitives.push_back(std::move(span));
    }
    const size_t count = character_.positions.size() - first;
    if (count > 0)
      character_.meshes.push_back({instance.node, first, count, instance.skin >= 0,
                                   inverse_or_identity(instance.bind_from_mesh), mesh.name});
    else
      character_.primitives.resize(first_primitive);
  }

  // Returns TEXCOORD_0 of all vertices.
  std::vector<Vector2> finish() {
    for (auto& [material, vertices] : painted_by_) {
      std::ranges::sort(vertices);
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      character_.materials.push_back({material_name(material), std::move(vertices)});
    }
    if (!painted_) character_.stiffness.clear();
    if (!has_normals_)
      source_.note("", "no normals in at least one primitive: computed, smooth below 60 degrees");
    return std::move(uv_);
  }

 private:
  std::string place(const MeshInstance& instance, size_t primitive) const {
    const std::string& name = model_.meshes[static_cast<size_t>(instance.mesh)].name;
    return "mesh " + std::to_string(instance.mesh) + (name.empty() ? "" : " '" + name + "'") + " primitive " +
           std::to_string(primitive);
  }

  // Empty: it has none, or is none.
  std::string material_name(int material) const {
    const auto index = static_cast<size_t>(material);
    return material < 0 || index >= model_.materials.size() ? "" : model_.materials[index].name;
  }

  bool usable(const tinygltf::Primitive& primitive, const MeshInstance& instance, const std::string& where) {
    if (!is_triangle_mode(primitive.mode)) return source_.note(where, "points or lines: left out"), false;
    if (!primitive.attributes.contains("POSITION"))
      return source_.note(where, "no POSITION: left out"), false;
    if (primitive.extensions.contains("KHR_draco_mesh_compression"))
      source_.refuse(where, "is compressed by KHR_draco_mesh_compression", "export without mesh compression");
    if (!primitive.targets.empty())
      source_.note(where,
                   std::to_string(primitive.targets.size()) +
                       (is_morphed(instance) ? " morph targets: the shape that they have by default is baked"
                                             : " morph targets: ignored"));
    return true;
  }

  std::vector<double> attribute(const tinygltf::Primitive& primitive, const std::string& name, int width,
                                size_t count, const std::string& where) const {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return {};
    const std::string place = where + " " + name;
    if (accessors_.count(found->second, place) != count)
      source_.refuse(place,
                     "has " + std::to_string(accessors_.count(found->second, place)) + " elements for " +
                         std::to_string(count) + " vertices",
                     kMend);
    return accessors_.numbers(found->second, width, place);
  }

  // Of an attribute, with what the mesh's default morph weights add to its first three numbers.
  std::vector<double> morphed(const tinygltf::Primitive& primitive, const MeshInstance& instance,
                              const std::string& name, size_t count, const std::string& where,
                              size_t width = 3) const {
    std::vector<double> values = attribute(primitive, name, static_cast<int>(width), count, where);
    if (values.empty()) return values;
    for (size_t t = 0; t < std::min(primitive.targets.size(), instance.morph_weights.size()); ++t) {
      const auto found = primitive.targets[t].find(name);
      const double weight = instance.morph_weights[t];
      if (found == primitive.targets[t].end() || weight == 0) continue;
      const std::string place = where + " morph target " + std::to_string(t) + " " + name;
      if (accessors_.count(found->second, place) != count)
        source_.refuse(place,
                       "has " + std::to_string(accessors_.count(found->second, place)) + " elements for " +
                           std::to_string(count) + " vertices",
                       kMend);
      const std::vector<double> moved = accessors_.numbers(found->second, 3, place);
      for (size_t v = 0; v < count; ++v)
        for (size_t k = 0; k < 3; ++k) values[width * v + k] += weight * moved[3 * v + k];
    }
    return values;
  }

  // What no character is refused for.
  template <class Read>
  std::vector<double> ornament(const std::string& name, const std::string& where, const Read& read) {
    try {
      return read();
    } catch (const BadInput&) {
      source_.note(where, "its " + name + " cannot be read: left out");
      return {};
    }
  }

  void share_vertices(int owner, PrimitiveSpan& span) const {
    const PrimitiveSpan& other = character_.primitives[static_cast<size_t>(owner)];
    span.first_vertex = other.first_vertex, span.vertex_count = other.vertex_count;
    span.sharer = owner;
  }

  void append_vertices(const tinygltf::Primitive& primitive, const MeshInstance& instance,
                       const std::string& where, PrimitiveSpan& span) {
    const size_t count = accessors_.count(primitive.attributes.at("POSITION"), where + " POSITION");
    span.first_vertex = character_.positions.size(), span.vertex_count = count;
    const std::vector<double> places = morphed(primitive, instance, "POSITION", count, where);
    const auto influences = read_influences(primitive, count, instance, joints_, accessors_, where, source_);
    const VertexSpaces spaces(instance, bind_from_joint_, influences);
    append_positions(places, spaces, where);
    append_normals(morphed(primitive, instance, "NORMAL", count, where), spaces, count, where);
    append_tangents(primitive, instance, spaces, count, where);
    append_uv(primitive, count, where);
    character_.skin.insert(character_.skin.end(), influences.begin(), influences.end());
    const std::vector<double> paint = read_paint(primitive, count, accessors_, where, source_);
    painted_ = painted_ || !paint.empty();
    character_.stiffness.insert(character_.stiffness.end(), paint.begin(), paint.end());
    const auto colors = read_vertex_colors(primitive, count, accessors_, where, source_);
    vertex_colors_.insert(vertex_colors_.end(), colors.begin(), colors.end());
    character_.colors.resize(character_.positions.size());
    character_.stiffness.resize(character_.positions.size(), 1.0);
  }

  void append_positions(const std::vector<double>& values, const VertexSpaces& spaces,
                        const std::string& where) {
    for (size_t v = 0; 3 * v < values.size(); ++v) {
      const Vector3 file(values[3 * v], values[3 * v + 1], values[3 * v + 2]);
      if (!file.allFinite())
        source_.refuse(where + " POSITION", "vertex " + std::to_string(v) + " is NaN or infinite",
                       "mend the mesh and export it again");
      character_.positions.push_back((spaces.of(v) * file.homogeneous()).head<3>());
    }
  }

  // Normals that the file lacks or that are no directions stay zero; smooth ones take their place later.
  void append_normals(const std::vector<double>& values, const VertexSpaces& spaces, size_t count,
                      const std::string& where) {
    has_normals_ = has_normals_ && !values.empty();
    size_t unusable = 0;
    for (size_t v = 0; v < count; ++v) {
      Vector3 normal = Vector3::Zero();
      if (!values.empty()) {
        normal = of_normals(spaces.of(v)) * Vector3(values[3 * v], values[3 * v + 1], values[3 * v + 2]);
        const bool direction = normal.allFinite() && normal.norm() > 0;
        if (!direction) ++unusable;
        normal = direction ? normal.normalized() : Vector3::Zero();
      }
      character_.normals.push_back(normal);
    }
    if (unusable > 0) source_.note(where, std::to_string(unusable) + " normals are zero or NaN: computed");
  }

  // Those that are no directions stay zero, as do all where there are no normals (glTF 2.0, 3.7.2.1).
  void append_tangents(const tinygltf::Primitive& primitive, const MeshInstance& instance,
                       const VertexSpaces& spaces, size_t count, const std::string& where) {
    std::vector<double> values;
    if (primitive.attributes.contains("NORMAL"))
      values = ornament("TANGENT", where,
                        [&] { return morphed(primitive, instance, "TANGENT", count, where, 4); });
    for (size_t v = 0; v < count; ++v) {
      Tangent tangent;
      if (!values.empty()) {
        const double* file = &values[4 * v];
        const Eigen::Matrix3d space = spaces.of(v).topLeftCorner<3, 3>();
        const Vector3 along = space * Vector3(file[0], file[1], file[2]);
        if (along.allFinite() && along.norm() > 0) tangent.along = along.normalized();
        if ((file[3] < 0) != (space.determinant() < 0)) tangent.sign = -1;
      }
      character_.tangents.push_back(tangent);
    }
  }

  void append_uv(const tinygltf::Primitive& primitive, size_t count, const std::string& where) {
    const std::vector<double> values =
        ornament("TEXCOORD_0", where, [&] { return attribute(primitive, "TEXCOORD_0", 2, count, where); });
    for (size_t v = 0; v < count; ++v)
      uv_.push_back(values.empty() ? Vector2::Constant(std::numeric_limits<double>::quiet_NaN())
                                   : Vector2(values[2 * v], values[2 * v + 1]));
  }

  void append_faces(const tinygltf::Primitive& primitive, const MeshInstance& instance,
                    const std::string& where, PrimitiveSpan& span) {
    const size_t count = span.vertex_count;
    std::vector<std::array<int, 3>> faces = read_triangles(primitive, count, accessors_, where, source_);
    const bool mirrored =
        !instance.in_joint_spaces && instance.bind_from_mesh.topLeftCorner<3, 3>().determinant() < 0;
    const LinearColor material = material_color(model_, primitive, where, source_);
    const std::vector<LinearColor> texture =
        textures_.at_vertices(primitive, count, accessors_, where, source_);
    for (auto& face : faces) {
      if (mirrored) std::swap(face[1], face[2]);
      for (int& corner : face) {
        const auto here = static_cast<size_t>(corner);
        corner += static_cast<int>(span.first_vertex);
        const auto vertex = static_cast<size_t>(corner);
        const LinearColor color =
            texture.empty() ? vertex_colors_[vertex] : product(texture[here], vertex_colors_[vertex]);
        character_.colors[vertex] = surface_color(material, color);
      }
    }
    span.first_triangle = character_.triangles.size(), span.triangle_count = faces.size();
    character_.triangles.insert(character_.triangles.end(), faces.begin(), faces.end());
    note_material(primitive.material, faces);
  }

  void note_material(int material, const std::vector<std::array<int, 3>>& faces) {
    if (material_name(material).empty()) return;
    std::vector<int>& vertices = painted_by_[material];
    for (const auto& face : faces) vertices.insert(vertices.end(), face.begin(), face.end());
  }

  const tinygltf::Model& model_;
  const AccessorReader& accessors_;
  const Joints& joints_;
  Source& source_;
  Character& character_;
  BaseColorTextures textures_;
  std::vector<Matrix4> bind_from_joint_;
  std::vector<LinearColor> vertex_colors_;      // of all vertices so far
  std::vector<Vector2> uv_;                     // the same
  std::map<int, std::vector<int>> painted_by_;  // the file's material -> vertices, often doubled
  bool painted_ = false, has_normals_ = true;
};

// Vertices and triangle corners that will be stored, counted from the accessors alone.
void check_size(const tinygltf::Model& model, const AccessorReader& accessors,
                const std::vector<MeshInstance>& instances, size_t max_vertices, const Source& source) {
  size_t vertices = 0, corners = 0, primitives = 0, morphed = 0;
  for (const MeshInstance& instance : instances) {
    const auto& list = model.meshes[static_cast<size_t>(instance.mesh)].primitives;
    std::map<VertexKey, bool> counted;
    for (const tinygltf::Primitive& primitive : list) {
      const std::string where = "mesh " + std::to_string(instance.mesh);
      if (++primitives > kMaxPrimitives)
        source.refuse("", "more than 65536 primitives", "join the character's meshes");
      const auto position = primitive.attributes.find("POSITION");
      if (position == primitive.attributes.end() || !is_triangle_mode(primitive.mode)) continue;
      const size_t count = accessors.count(position->second, where + " POSITION");
      corners += primitive.indices < 0 ? count : accessors.count(primitive.indices, where + " indices");
      if (counted.try_emplace(key_of(primitive), true).second) {
        vertices += count;
        if (is_morphed(instance))
          morphed += count * std::min(primitive.targets.size(), instance.morph_weights.size());
      }
      if (morphed > kMostTargets * max_vertices)
        source.refuse(where, "its morph targets move too many vertices by default",
                      "bake their shape into it");
      if (count > max_vertices || vertices > max_vertices)
        source.refuse(where,
                      "the character has more than " + std::to_string(max_vertices) + " vertices (" +
                          std::to_string(vertices) + " up to here)",
                      "reduce the mesh, a game character has fewer");
      if (corners > 16 * max_vertices)
        source.refuse(
            where, "the character has more than " + std::to_string(16 * max_vertices) + " triangle corners",
            "reduce the mesh");
    }
  }
}

}  // namespace

std::vector<Vector2> append_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                                   const Joints& joints, const std::vector<MeshInstance>& instances,
                                   size_t max_vertices, Source& source, Character& character) {
  check_size(model, accessors, instances, max_vertices, source);
  MeshReader reader(model, accessors, joints, source, character);
  for (const MeshInstance& instance : instances) reader.append(instance);
  return reader.finish();
}

}  // namespace sinew::baker

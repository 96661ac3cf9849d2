// creature.cpp  From recipe to file: mesh, skin, paint, details, clips, glTF.
#include "baker/creature/creature.hpp"

#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/creature/body_field.hpp"
#include "baker/creature/clip.hpp"
#include "baker/creature/detail.hpp"
#include "baker/creature/glb_writer.hpp"
#include "baker/creature/paint.hpp"
#include "baker/creature/remesh.hpp"
#include "baker/creature/skin.hpp"
#include "baker/creature/surface.hpp"

namespace sinew::baker {
namespace {

using Eigen::Vector3d;

struct Primitive {  // as it goes into the file
  std::string name, material;
  std::vector<float> positions = {}, normals = {}, weights = {}, stiffness = {};
  std::vector<uint16_t> colors = {};
  std::vector<uint8_t> joints = {};
  std::vector<uint32_t> indices = {};
};

void append(std::vector<float>& floats, const Vector3d& v) {
  for (int i = 0; i < 3; ++i) floats.push_back(static_cast<float>(v[i]));
}

void append_vertex(Primitive& primitive, const PaintSpot& spot, const Vector3d& color, double stiffness) {
  append(primitive.positions, spot.position);
  append(primitive.normals, spot.normal.normalized());
  for (size_t i = 0; i < kCreatureInfluences; ++i) {
    primitive.joints.push_back(static_cast<uint8_t>(spot.skin.joint[i]));
    primitive.weights.push_back(static_cast<float>(spot.skin.weight[i]));
  }
  for (int i = 0; i < 3; ++i)
    primitive.colors.push_back(static_cast<uint16_t>(std::lround(color[i] * 65535)));
  primitive.colors.push_back(65535);
  primitive.stiffness.push_back(static_cast<float>(stiffness));
}

void append_triangles(Primitive& primitive, const Surface& surface) {
  for (const auto& triangle : surface.triangles)
    for (int v : triangle) primitive.indices.push_back(static_cast<uint32_t>(v));
}

Surface mesh_body(const CreatureRecipe& recipe, const BodyField& field, size_t vertices) {
  constexpr double kCellsAlong = 100;  // the box's longest side; finer than the thinnest ear
  const Eigen::AlignedBox3d box = field.bounds();
  Surface surface = contour([&](const Vector3d& p) { return field.sample(p).distance; }, box,
                            box.sizes().maxCoeff() / kCellsAlong);
  const std::string fault = why_not_a_sphere(surface);
  if (!fault.empty())
    throw BadInput(recipe.name + ": the body is not one closed piece: " + fault +
                   "; move its parts together or apart, or widen \"blend_m\"");
  return remesh(field, std::move(surface), vertices);
}

Primitive make_body(const CreatureRecipe& recipe, const BodyField& field, size_t vertices) {
  const Surface surface = mesh_body(recipe, field, vertices);
  const std::vector<SkinWeights> skin = skin_body(recipe, surface);
  std::vector<PaintSpot> spots;
  for (size_t v = 0; v < surface.positions.size(); ++v)
    spots.push_back(
        {surface.positions[v], field.sample(surface.positions[v]).gradient.normalized(), skin[v]});
  const std::vector<Vector3d> colors = paint_color(recipe, spots);
  const std::vector<double> stiffness = paint_stiffness(recipe, spots);
  Primitive body{.name = "body", .material = recipe.materials[0].name};
  for (size_t v = 0; v < spots.size(); ++v) append_vertex(body, spots[v], colors[v], stiffness[v]);
  append_triangles(body, surface);
  return body;
}

Primitive make_detail_primitive(const CreatureRecipe& recipe, const BodyField& field, DetailRecipe detail,
                                size_t vertices) {
  if (detail.snap)
    for (Eigen::Vector4d& point : detail.solid.points) point.head<3>() = field.project(point.head<3>());
  const DetailSurface made = make_detail(detail, vertices);
  SkinWeights skin;
  skin.joint[0] = joint_index(recipe, detail.joint);
  skin.weight[0] = 1;
  Primitive primitive{.name = detail.name, .material = detail.material};
  for (size_t v = 0; v < made.normals.size(); ++v)
    append_vertex(primitive, {made.surface.positions[v], made.normals[v], skin}, made.colors[v], 1);
  append_triangles(primitive, made.surface);
  return primitive;
}

// Details of one material share a primitive: fewer draw calls for the engine.
void merge_same_material(std::vector<Primitive>& primitives, Primitive added) {
  const auto append_all = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (size_t i = 1; i < primitives.size(); ++i) {
    Primitive& kept = primitives[i];
    if (kept.material != added.material) continue;
    const uint32_t first = static_cast<uint32_t>(kept.positions.size() / 3);
    for (uint32_t index : added.indices) kept.indices.push_back(first + index);
    append_all(kept.positions, added.positions);
    append_all(kept.normals, added.normals);
    append_all(kept.weights, added.weights);
    append_all(kept.stiffness, added.stiffness);
    append_all(kept.colors, added.colors);
    append_all(kept.joints, added.joints);
    return;
  }
  primitives.push_back(std::move(added));
}

std::vector<Primitive> make_primitives(const CreatureRecipe& recipe, size_t vertices) {
  const BodyField field(recipe.body);
  std::vector<Primitive> primitives(1);
  size_t in_details = 0;
  constexpr double kTooSmallToSee = 4;  // vertices; a coarse creature goes without glints and lips
  for (const DetailRecipe& detail : recipe.details) {
    const double wanted = detail.share * static_cast<double>(vertices);
    if (wanted < kTooSmallToSee) continue;
    Primitive made = make_detail_primitive(recipe, field, detail, static_cast<size_t>(wanted));
    in_details += made.positions.size() / 3;
    merge_same_material(primitives, std::move(made));
  }
  primitives[0] = make_body(recipe, field, vertices - std::min(in_details, vertices / 2));
  return primitives;
}

class FileMaker {
 public:
  explicit FileMaker(const CreatureRecipe& recipe) : recipe_(recipe) {
    glb_.document["asset"] = {{"version", "2.0"}, {"generator", "sinew-bake creature"}};
    glb_.document["scene"] = 0;
    glb_.document["scenes"] = {{{"name", recipe.name}, {"nodes", {0, 1}}}};
  }

  std::vector<std::byte> run(const std::vector<Primitive>& primitives) {
    add_nodes();
    add_skin();
    add_materials();
    add_mesh(primitives);
    for (const ClipRecipe& clip : recipe_.clips) add_clip(key_clip(recipe_, clip));
    return glb_.finish();
  }

 private:
  static size_t node_of(int joint) { return static_cast<size_t>(joint) + 1; }  // node 0 holds the mesh

  void add_nodes() {
    auto& nodes = glb_.document["nodes"];
    nodes.push_back({{"name", recipe_.name}, {"mesh", 0}, {"skin", 0}});
    for (size_t j = 0; j < recipe_.joints.size(); ++j) {
      const Vector3d offset = rest_offset(recipe_, static_cast<int>(j));
      nodes.push_back(
          {{"name", recipe_.joints[j].name}, {"translation", {offset.x(), offset.y(), offset.z()}}});
      if (j == 0) continue;
      nodes[node_of(joint_index(recipe_, recipe_.joints[j].parent))]["children"].push_back(j + 1);
    }
  }

  void add_skin() {
    std::vector<float> inverse_bind;
    nlohmann::json joints;
    for (size_t j = 0; j < recipe_.joints.size(); ++j) {
      joints.push_back(j + 1);
      const Eigen::Vector3f at = recipe_.joints[j].at.cast<float>();
      const float column_major[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -at.x(), -at.y(), -at.z(), 1};
      inverse_bind.insert(inverse_bind.end(), column_major, column_major + 16);
    }
    const size_t accessor = glb_.add_floats(inverse_bind, 16, GlbWriter::kNone);
    glb_.document["skins"] = {
        {{"name", recipe_.name}, {"joints", joints}, {"skeleton", 1}, {"inverseBindMatrices", accessor}}};
  }

  void add_materials() {
    for (const MaterialRecipe& material : recipe_.materials) {
      nlohmann::json json = {
          {"name", material.name},
          {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", material.roughness}}}};
      const Vector3d glow = linear_from_srgb(material.emissive);
      if (!glow.isZero()) json["emissiveFactor"] = {glow.x(), glow.y(), glow.z()};
      glb_.document["materials"].push_back(json);
    }
  }

  size_t material_index(const std::string& name) const {
    for (size_t m = 0; m < recipe_.materials.size(); ++m)
      if (recipe_.materials[m].name == name) return m;
    return 0;
  }

  void add_mesh(const std::vector<Primitive>& primitives) {
    nlohmann::json list;
    for (const Primitive& p : primitives) {
      const nlohmann::json attributes = {
          {"POSITION", glb_.add_floats(p.positions, 3, GlbWriter::kVertices, true)},
          {"NORMAL", glb_.add_floats(p.normals, 3, GlbWriter::kVertices)},
          {"COLOR_0", glb_.add_shorts(p.colors, 4, GlbWriter::kVertices, true)},
          {"JOINTS_0", glb_.add_bytes(p.joints, 4, GlbWriter::kVertices)},
          {"WEIGHTS_0", glb_.add_floats(p.weights, 4, GlbWriter::kVertices)},
          {"_STIFFNESS", glb_.add_floats(p.stiffness, 1, GlbWriter::kVertices)}};
      list.push_back({{"attributes", attributes},
                      {"indices", glb_.add_indices(p.indices)},
                      {"material", material_index(p.material)}});
    }
    glb_.document["meshes"] = {{{"name", recipe_.name}, {"primitives", list}}};
  }

  void add_clip(const ClipKeys& keys) {
    std::vector<float> times;
    for (double t : keys.times_s) times.push_back(static_cast<float>(t));
    const size_t input = glb_.add_floats(times, 1, GlbWriter::kNone, true);
    nlohmann::json animation = {
        {"name", keys.name}, {"channels", nlohmann::json::array()}, {"samplers", nlohmann::json::array()}};
    for (const JointKeys& joint : keys.joints) {
      std::vector<Eigen::VectorXd> rotation, translation;
      for (const auto& q : joint.rotation) rotation.push_back(q.coeffs());
      for (const auto& v : joint.translation) translation.push_back(v);
      add_channel(animation, input, node_of(joint.joint), "rotation", rotation, keys.times_s);
      add_channel(animation, input, node_of(joint.joint), "translation", translation, keys.times_s);
    }
    glb_.document["animations"].push_back(animation);
  }

  // Cubic spline keys with central differences around the loop: velocity does not jump where the clip begins
  // again.
  void add_channel(nlohmann::json& animation, size_t input, size_t node, const char* path,
                   const std::vector<Eigen::VectorXd>& values, const std::vector<double>& times_s) {
    if (values.empty()) return;
    const size_t last = values.size() - 1;
    const double step_s = times_s[1] - times_s[0];
    std::vector<float> output;
    for (size_t k = 0; k <= last; ++k) {
      const Eigen::VectorXd& before = values[k == 0 ? last - 1 : k - 1];
      const Eigen::VectorXd& after = values[k == last ? 1 : k + 1];
      const Eigen::VectorXd tangent = (after - before) / (2 * step_s);
      for (const Eigen::VectorXd& part : {tangent, values[k], tangent})
        for (long i = 0; i < part.size(); ++i) output.push_back(static_cast<float>(part[i]));
    }
    const size_t width = static_cast<size_t>(values[0].size());
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back({{"input", input},
                                     {"output", glb_.add_floats(output, width, GlbWriter::kNone)},
                                     {"interpolation", "CUBICSPLINE"}});
  }

  const CreatureRecipe& recipe_;
  GlbWriter glb_;
};

}  // namespace

std::vector<std::byte> make_creature(const CreatureRecipe& recipe, size_t vertices) {
  if (vertices == 0) vertices = recipe.vertices;
  if (vertices < kFewestCreatureVertices || vertices > kMostCreatureVertices)
    throw BadInput(recipe.name + ": " + std::to_string(vertices) + " vertices asked for; choose " +
                   std::to_string(kFewestCreatureVertices) + " .. " + std::to_string(kMostCreatureVertices));
  return FileMaker(recipe).run(make_primitives(recipe, vertices));
}

}  // namespace sinew::baker

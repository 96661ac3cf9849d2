// character.hpp  An imported character: what every room of the baker reads. Metres, Y up, right-handed.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sinew::baker {

using Matrix4 = Eigen::Matrix4d;
using Vector3 = Eigen::Vector3d;

inline constexpr int kInfluences = 8;

struct Influences {
  std::array<int, kInfluences> joint{};      // unused slots: joint 0, weight 0
  std::array<double, kInfluences> weight{};  // descending, sum 1
};

// What VRMC_node_constraint lets turn a node: kRotation: as its source turns; kRoll: as far as that turns
// about an axis; kAim: towards the source.
enum class ConstraintKind { kNone, kRotation, kRoll, kAim };

struct Constraint {
  ConstraintKind kind = ConstraintKind::kNone;
  int source = 0;                   // node
  Vector3 axis = Vector3::UnitX();  // of its own: kRoll, kAim
  double weight = 1;                // 0 .. 1
};

struct Node {  // a node of the file's scene graph; parents come before children
  std::string name;
  int parent = -1;
  bool has_matrix = false;  // matrix nodes are not animated; others use translation, rotation, scale
  Matrix4 matrix = Matrix4::Identity();
  Vector3 translation = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vector3 scale = Vector3::Ones();
  Constraint constraint;
};

enum class Interpolation { kStep, kLinear, kCubicSpline };
enum class Path { kTranslation, kRotation, kScale };

struct Channel {
  int node = 0;
  Path path = Path::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> times_s;  // ascending
  std::vector<double>
      values;  // 3 or 4 a key (rotation x y z w); cubic spline: in-tangent, value, out-tangent a key
};

struct Clip {
  std::string name;
  double duration_s = 0;
  std::vector<Channel> channels;
};

// What a VRM file states of a bone that swings.
struct SpringNumbers {
  double stiffness = 1;                           // 0 .. 4: pull to the rest direction
  double gravity_power = 0;                       // pull along the direction
  Vector3 gravity_direction = -Vector3::UnitY();  // unit
  double drag_force = 0.4;  // 0 .. 1: share of its velocity that a bone loses in a frame
  double hit_radius_m = 0;  // for collisions; 0: as thick as its flesh

  bool operator==(const SpringNumbers&) const = default;
};

// Bones that a VRM file lets swing: a root joint and all that hangs on it, or what lies between it and `end`.
struct SpringBones {
  std::string name;
  int root = 0, end = -1;  // joints; -1: no end is stated, all below the root swings
  int end_node = -1;       // where the bone of `end` ends; -1: where its child is
  // Of a root with nothing below it: so long, pointing away from its parent. 0: such a root has no end.
  double tail_m = 0;
  SpringNumbers numbers = {};  // of the root, and of what has none of its own
  std::vector<std::pair<int, SpringNumbers>> of_joints = {};
  std::vector<int> collider_groups = {};  // of BodyCollider::groups, that it collides with
};

// A sphere or capsule that a VRM file lets springs collide with, in its joint's own space.
struct BodyCollider {
  int joint = 0;
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();
  double radius_m = 0;
  std::vector<int> groups = {};  // that it is in
};

// Vertices of one mesh of the file.
struct MeshSpan {
  int node = 0;  // that shows it
  size_t first_vertex = 0, vertex_count = 0;
  bool skinned = false;  // else it hangs on one joint
  // Of a place in the bind pose to the file's own mesh space; of a skin without binds to the scene.
  Matrix4 mesh_from_bind = Matrix4::Identity();
  std::string name = {};  // the mesh's own, beside its node's
};

// A primitive of a mesh, of triangles; see pack::PrimitiveRecord.
struct PrimitiveSpan {
  size_t mesh = 0;            // of Character::meshes
  std::string material = {};  // its name; empty: it has none
  size_t first_vertex = 0, vertex_count = 0;
  size_t first_triangle = 0, triangle_count = 0;
  size_t index = 0;  // among the primitives of its mesh in the file
  int sharer = -1;  // of Character::primitives: the one before it that has its vertices; -1: they are its own
};

// As in glTF: the bitangent is sign (normal x along).
struct Tangent {
  Vector3 along = Vector3::Zero();  // unit
  double sign = 1;                  // 1 or -1
};

// Vertices of the triangles that one material of the file paints. Where primitives share vertices, one may be
// on several.
struct MaterialVertices {
  std::string name;
  std::vector<int> vertices;  // ascending
};

struct Character {
  std::string name;
  double unit_m = 1;  // metres that a unit of the file is
  std::vector<Node> nodes;
  std::vector<int> joint_node;        // joint -> node; parents before children
  std::vector<int> joint_parent;      // nearest ancestor that is a joint, -1 for none
  std::vector<Matrix4> inverse_bind;  // joint-from-character in the bind pose
  Matrix4 character_from_scene =
      Matrix4::Identity();  // unit and up-axis conversion, applied left of every node's global

  // Vertices in file order, primitive after primitive, as the engine has them.
  std::vector<Vector3> positions;  // bind pose
  std::vector<Vector3> normals;    // unit; computed where the file has none
  std::vector<Tangent> tangents;   // computed where the file has none; empty: nothing to compute them from
  std::vector<Influences> skin;
  std::vector<std::array<uint8_t, 4>> colors;  // material x vertex colour; for pictures
  std::vector<double> stiffness;               // painted _STIFFNESS, 0 soft .. 1 rigid; empty: not painted
  std::vector<std::array<int, 3>> triangles;
  std::vector<MeshSpan> meshes;             // in the order of their vertices
  std::vector<PrimitiveSpan> primitives;    // mesh after mesh; of a character that was made: none
  std::vector<MaterialVertices> materials;  // those in use that have names, in the file's order

  std::vector<int> welded;  // vertex -> first vertex at much the same place with much the same influences
  std::vector<Clip> clips;
  std::vector<SpringBones> springs;
  std::vector<BodyCollider> colliders;
  std::vector<std::string> notes;  // what was mended or dropped on import, one line each
};

// character-from-joint of every joint at t_s (clamped to the clip); clip null: the file's rest pose.
std::vector<Matrix4> joint_matrices(const Character& character, const Clip* clip, double t_s);

// character-from-joint of every joint as the skins were bound, which is no frame of the file's.
std::vector<Matrix4> bind_matrices(const Character& character);
// Along Y, of the bind pose.
double height_m(const Character& character);

// Linear blend skinning in double: positions of all vertices under these joint matrices.
std::vector<Vector3> skin_positions(const Character& character, const std::vector<Matrix4>& joints);

}  // namespace sinew::baker

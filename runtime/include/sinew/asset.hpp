// asset.hpp  What a loaded character tells of itself. All of it in the bind pose's metres, right-handed, Y
// up.
//
// Names and arrays lie in the pack and live as long as the asset.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "sinew/matrix.hpp"

namespace sinew {

inline constexpr uint32_t kNone = 0xffffffffu;  // no index

struct AssetInfo {
  uint32_t vertex_count = 0, triangle_count = 0, joint_count = 0, region_count = 0, node_count = 0,
           clip_count = 0;
  uint32_t mesh_count = 0;          // World::mesh_info
  uint32_t primitive_count = 0;     // World::primitive_info
  uint32_t moved_vertex_count = 0;  // AssetArrays::moved_vertices
  uint32_t proxy_count = 0;         // capsules about bones, for ContactDef::own_body: World::proxy_info
  uint32_t rod_count = 0;           // chains and trees of bones that swing
  bool rod_network = false;         // the pack holds what RodWarmStart::kLearned takes
  uint32_t graph_levels = 1;  // control graphs, each coarser than the one before, that tiers are simulated on
  float tick_hz = 0;
  float height_m = 0;           // extent of the bind pose along Y
  float unit_m = 1;             // metres that one of the baked file's units is
  uint64_t instance_bytes = 0;  // memory one instance takes; contacts take more
};

// Spans of an unloaded asset are not to be used.
struct AssetArrays {
  std::span<const float> positions_m = {},
                         normals = {};   // [vertices][3], bind pose; normals are unit vectors
  std::span<const float> tangents = {};  // [vertices][4], w = +-1 as in glTF; empty: the file has none, nor
                                         // texture coordinates
  std::span<const uint32_t> triangles = {};  // [triangles][3], vertices
  // Ascending. Of all others Space::kBind is zero for ever; the normals of those that share a triangle with
  // these turn a little all the same.
  std::span<const uint32_t> moved_vertices = {};
  // Influence k of vertex v: skin_joints[k], skin_weights[k] as they are v * skin_stride_bytes further on.
  // kSkinInfluences of each, descending, sum 1; unused ones are 0.
  const uint16_t* skin_joints = nullptr;
  const float* skin_weights = nullptr;
  size_t skin_stride_bytes = 0;
};
inline constexpr uint32_t kSkinInfluences = 8;

// Vertices of one mesh, as one node of the baked file shows it. Meshes follow one another and cover all
// vertices, and so do their primitives.
struct MeshInfo {
  const char* name = nullptr;  // of the node
  uint32_t first_vertex = 0, vertex_count = 0;
  uint32_t first_primitive = 0, primitive_count = 0;
  // From the bind pose (Space::kBind, metres) to the mesh space of the file, in the file's unit: of a bind
  // position the whole matrix, of a displacement its first three columns. It holds the unit, the up axis and
  // whatever space the exporter wrote the mesh in. To the file's scene instead where a skin has no bind
  // matrices (its rest pose was baked), and where the mesh's node flattens it.
  Matrix34 mesh_from_bind = {};
};

// What one material paints. Its vertex i is element i of the file's POSITION accessor, and none is left out.
// Primitives of a mesh with the same accessors share their vertices. Its triangles are the file's in their
// order, strips and fans as triangles; those without area are left out, and of a mesh that its place in the
// scene mirrors the last two corners are swapped.
struct PrimitiveInfo {
  uint32_t mesh = 0;
  uint32_t index = 0;              // which one of the file's mesh, points and lines counted
  const char* material = nullptr;  // null: it has no name
  uint32_t first_vertex = 0, vertex_count = 0;
  uint32_t first_triangle = 0, triangle_count = 0;
};

struct JointInfo {
  const char* name = nullptr;  // in the file; several may have the same: World::joint_path tells them apart
  uint32_t parent = kNone;     // a smaller index than its own; kNone: a root
  uint32_t rod = kNone;        // that moves it, as its bone or as what hangs on one; kNone: none does
  Matrix34 inverse_bind = {};  // joint-from-character in the bind pose
};

// A soft part.
struct RegionInfo {
  const char* name = nullptr;
  std::span<const uint32_t> vertices = {};  // that it carries, ascending
  uint32_t node_count = 0;                  // of the finest control graph
  float center_m[3] = {};
  float radius_m = 0;
  float displacement_limit_m = 0;
  float frequency_hz = 0, damping_ratio = 0;  // of its slowest mode; damping 0 where it has no modes
};

// A chain or tree of bones that swings. Its bones are the joints whose JointInfo::rod it is.
struct RodInfo {
  const char* name = nullptr;
  uint32_t attach_joint = 0;   // that it hangs on
  uint32_t end_joint = kNone;  // that holds its end; kNone: it is free
  uint32_t segment_count = 0;
  float length_m = 0;        // of all segments together
  float frequency_hz = 0;    // roughly, of its slowest swing; 0: not known
  float gravity = 0;         // times the earth's
  float turn_limit_rad = 0;  // of a segment against its rest; 0: none
  float damping_ratio = 0;   // roughly, of that swing; 0 also where the frequency is not known
};

// A capsule about a bone, that moves as its joint does.
struct ProxyInfo {
  uint32_t joint = 0;
  float from_m[3] = {}, to_m[3] = {};  // the axis' ends, bind pose; the same: a sphere
  float radius_m = 0;
};

struct ClipInfo {
  const char* name = nullptr;
  float duration_s = 0;
  uint32_t frame_count = 0;
  float rate_hz = 0;
};

enum class ClipEnd : uint32_t {
  kHold = 0,  // before its begin and beyond its end it stands
  kLoop = 1,  // time is taken modulo its duration
};

}  // namespace sinew

// read.hpp  What of the surface is read, and in which form.
#pragma once
#include <cstddef>
#include <cstdint>

namespace sinew {

// Where positions are written and in which space.
enum class Space : uint32_t {
  kCharacter = 0,  // the pose's character space
  kWorld = 1,      // root applied, relative to origin_m below
  // Before skinning. Of positions the displacement (a delta, not a place): metres along the axes of character
  // space, in which World::bind_pose has the joints (Y up; of a file in centimetres or with Z up it is not
  // the file's). Added to the bind position before GPU skinning it gives kCharacter's. Zero where nothing is
  // carried, and never longer than half of the bind pose's largest extent, but for rounding, whatever poses,
  // contacts, parameters and frame rates do (runtime/character/output/displacement_bound.hpp). For vertices
  // as the file has them, MeshInfo::mesh_from_bind takes it to the file's mesh space. Normals and tangents
  // are those of the bind pose so displaced, whole, to be skinned as the file's own; where weights bend
  // sharply, ordinary skinning makes other normals of them than kCharacter has.
  kBind = 2,
};

// Positions, or normals, alone.
struct ReadDef {
  Space space = Space::kCharacter;
  double origin_m[3] = {0, 0, 0};  // kWorld: subtracted in double before rounding to float; NaN: refused
  float* out = nullptr;            // first vertex's x; y and z follow it; aligned to 4 bytes; null: refused
  size_t stride_bytes = 12;  // >= 12, a multiple of 4, else refused; bytes between vertices are left alone
  size_t capacity = 0;  // vertices that fit; fewer than the asset's vertex_count: refused, nothing written
};

enum class VertexFormat : uint32_t {
  kFloat3 = 0,
  kFloat4 = 1,  // the fourth of a position is 1, of a displacement and a normal 0, of a tangent its +-1
  kHalf4 = 2,   // the same as IEEE halves, rounded to nearest
};

// One attribute of the vertices.
struct VertexStream {
  void* out = nullptr;  // the first vertex's; aligned to 4 bytes (kHalf4: 2), else refused; null: not wanted
  size_t stride_bytes = 0;  // a multiple of 4 (kHalf4: 2), and not below the format's bytes, else refused; 0:
                            // one right behind the other. Bytes between vertices are left alone
  VertexFormat format = VertexFormat::kFloat3;
};

struct SurfaceReadDef {
  Space space = Space::kCharacter;
  double origin_m[3] = {0, 0, 0};  // as in ReadDef
  // Only AssetArrays::moved_vertices, one right after the other in that order.
  bool moved_only = false;
  size_t capacity = 0;  // vertices that fit into each stream; fewer than are written: refused
  VertexStream positions = {}, normals = {};
  VertexStream tangents = {};  // of an asset without: refused
};

// A point on a triangle: the sum of its corners, weighted; also beyond its edges.
struct SurfacePlace {
  uint32_t triangle = 0;
  float weights[3] = {1, 0, 0};  // finite, sum 1 within 1e-3
};

struct PointsDef {
  Space space = Space::kCharacter;  // not kBind
  double origin_m[3] = {0, 0, 0};   // as in ReadDef
};

// A ball that holds all of what is shown.
struct Bounds {
  double center_m[3] = {};  // in the world
  float radius_m = 0;
};

// What debug_lines draws; add them up.
enum DebugParts : uint32_t {
  kDebugNodes = 1,    // of soft parts, from where skinning has them to where they are
  kDebugRods = 2,     // bones that swing
  kDebugProxies = 4,  // capsules about bones
  kDebugTouches = 8,  // what soft parts touched in the last tick: the way out, 5 % of the height long
  kDebugBounds = 16,
  kDebugAll = 31,
};

struct DebugLine {
  float from_m[3], to_m[3];
  uint32_t rgba;  // 0xRRGGBBAA
};

}  // namespace sinew

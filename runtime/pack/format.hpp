// format.hpp  The .sinew baked file. This comment and these structs are the specification.
//
//   [FileHeader 64 bytes][SectionEntry x section_count][padding]...[section][padding][section]...
//
// Little-endian. The table starts at byte 64. Every section starts on a 64-byte boundary and is an array of
// `count` elements of `element_bytes`. The table ascends by kind, so that a kind appears at most once;
// sections lie in the table's order, each at the next multiple of 64 after the one before it, and the file
// ends at a multiple of 64. Gaps hold zeros. Thus equal content has equal bytes, and no byte of a file is
// unchecked. A section without elements may be left out. A reader maps the file and uses it in place: no
// fix-ups, no copies. Everything that indexes something is checked once, on load (pack/reader); after that
// the runtime trusts it.
//
// A pack is a *model* (kinds below 20 only: what `sinew-bake check` runs) or a *character* (all of the
// sections; its network, if it has one, has inputs).
//
// Version history. A version is never reused; a reader takes only its own and names the command that rebakes
// the others.
//   1  first format
//   2  tissue lives in node frames on a modal base; tiers modal and spring; a character may have no network
//   3  node frames follow a share of their region's bend (RegionRecord::anchor_node); inputs that tell the
//   bend
//      since then without a new version, for a reader that does not know them refuses the field or the kind:
//      NetworkRecord::precision with the int8 sections; the inputs kTurnedForce .. kSpunVelocity
//   4  what a region's modes hear lies input by input, so that no sum runs across a vector's lanes
//      since then, likewise: the models kDeepEmulator and kCopingNet with the section kDense
//   5  weights of Alt-ConvLSTM lie in the order that kernels read them; CharacterRecord::rod_count with the
//      sections of rods, and a character of rods without soft regions
//      since then, likewise: CharacterRecord::proxy_count with the section kProxies
//   6  what a tier costs and how far it is off may be measured, its tail with it, and tiers simulated every
//      second tick stand beside those of every tick
//      since then, likewise: CharacterRecord::coarser_count with the sections kLevels, kPicks and kSpread,
//      TierRecord::level, and RegionRecord::touches_body; RodRecord::turn_limit_rad and frequency_hz; a
//      character of which nothing swings
//   7  normals are the file's own and turn with the surface (kFaceNormals; kWelded tells sides apart);
//   kMeshes;
//      a rod states which way its gravity pulls and which capsules it passes
//   8  a tier tells its error along the motion in which it is largest, and which that is
//   9  no update rates and no spring tier: the scheduler bought neither
//      since then without a new version, for a reader that does not know it refuses the field:
//      RodRecord::end_holder; RodRecord::start, with the sections kRodNetwork, kRodDense and kRodWeights;
//      RegionRecord::cell_m, with the sections kPatch...; NetworkRecord::moving
//   10 an emulator that sees patches from a moving frame is told two ticks of them, not three
//   11 what an engine needs to know of the file: which vertices and triangles are which primitive's, and its
//      material (kPrimitives); tangents (kTangents); what a unit of the file is (CharacterRecord::unit_m)
#pragma once
#include <cstddef>
#include <cstdint>

namespace sinew::pack {

inline constexpr char kMagic[8] = {'S', 'I', 'N', 'E', 'W', 'P', 'K', '\0'};
inline constexpr uint32_t kVersion = 11;
inline constexpr size_t kSectionAlignment = 64;
inline constexpr uint32_t kNoIndex = 0xffffffffu;

inline constexpr uint32_t kPanel = 64;  // outputs of one layer whose weights lie together

// Rows of channels are padded to whole 16.
constexpr uint64_t round_up_16(uint64_t value) noexcept { return (value + 15) / 16 * 16; }

enum class FileKind : uint32_t { kModel = 1, kCharacter = 2 };

struct FileHeader {
  char magic[8];
  uint32_t version;
  FileKind kind;
  uint64_t file_bytes;      // whole file
  uint32_t section_count;   // <= 64
  uint32_t reserved0;       // 0
  uint64_t table_checksum;  // core/hash of the section table
  uint64_t reserved[3];     // 0
};
static_assert(sizeof(FileHeader) == 64, "the header is one cache line; a change is a new version");

struct SectionEntry {
  uint32_t kind;           // SectionKind; a reader passes over kinds it does not know
  uint32_t element_bytes;  // must be the size this version states for the kind
  uint64_t count;          // elements
  uint64_t offset;         // from the start of the file, a multiple of 64
  uint64_t checksum;       // core/hash of the section's bytes
};
static_assert(sizeof(SectionEntry) == 32, "a change is a new version");

// Values are in files: never renumbered.
enum class SectionKind : uint32_t {
  kStrings = 1,   // char; zero-terminated UTF-8, named elsewhere by byte offset; the last byte is 0
  kMetadata = 2,  // char; the weights file's __metadata__ as JSON, kept whole and shown by `info`

  kNetwork = 10,  // NetworkRecord x 1
  kLayers = 11,   // LayerRecord x layers
  kInputs = 12,   // InputRecord x inputs; a model without: the paper's wiring
  kWeights = 13,  // float; the layers' tensors, laid out as LayerRecord says
  // Of an int8 network, hidden layer after hidden layer, no gaps (baker/pack/network/int8_layout.hpp); k in
  // fours:
  kInt8Weights = 14,  // int8, +-127: for each 16 channels [k of x, h / 4][i f c o][16][4], then
                      // [k of P y / 4][i f][16][4]; behind all channels gate o's [k of P y / 4][padded][4]
  kInt8Sums = 15,     // int32: 128 sum_k w, [padded / 16][i f c o][16], then [padded] of gate o's P y
  kInt8Scales = 16,   // float, >= 0: per_unit [k], then scale as kInt8Sums
  kDense = 17,        // DenseRecord x layers of a network of chains, which has no kLayers and no kInputs

  kCharacter = 20,    // CharacterRecord x 1
  kJoints = 21,       // JointRecord x joints
  kPositions = 22,    // float[3] x vertices, bind pose, metres
  kNormals = 23,      // float[3] x vertices, unit; bind pose, the file's where it has any
  kTriangles = 24,    // uint32[3] x triangles
  kSkin = 25,         // SkinRecord x vertices
  kColors = 26,       // uint8[4] x vertices, sRGB and alpha; for pictures, the runtime never reads it
  kWelded = 27,       // uint32 x vertices: the first vertex at the same place that faces alike
  kFaceNormals = 28,  // float[3] x vertices: of the triangles around its place and side, by area, bind pose;
                      // unit, or zero where none has area
  kMeshes = 29,       // MeshRecord x meshes

  kRegions = 30,         // RegionRecord x regions
  kNodes = 31,           // NodeRecord x nodes: control nodes of all regions, region after region
  kGraphRows = 32,       // uint32 x nodes + 1: CSR rows of P = D^-1/2 (A + I) D^-1/2
  kGraphColumns = 33,    // uint32, ascending in a row, nodes of the row's own region
  kGraphValues = 34,     // float
  kRegionVertices = 35,  // uint32: the vertices a region carries, region after region, ascending in a region
  kCarry = 36,           // float: weights from nodes to vertices, see RegionRecord
  kRegionModes = 37,     // RegionModesRecord x regions
  kModes = 38,           // ModeRecord x modes: of all regions, region after region
  kModeMatrices = 39,    // float: see RegionModesRecord

  kClips = 40,       // ClipRecord x clips
  kClipFrames = 41,  // float[12]: character-from-joint, [frame][joint], row-major 3x4

  // 45 and 46 were the spring tier's.

  // Of a character with coarser control graphs beside its own; see LevelRecord.
  kLevels = 47,  // LevelRecord x 1 + coarser_count, finest first
  kPicks = 48,   // uint32 x nodes of the coarser levels: the node of the next finer level that each is
  kSpread = 49,  // float: see LevelRecord

  kTiers = 50,  // TierRecord x tiers

  kPrimitives = 51,  // PrimitiveRecord x primitives
  // float[4] x vertices, bind pose: a unit vector, then w, +-1, as glTF has it: the bitangent is w (normal x
  // tangent). The file's own, in the space of its normals, where a primitive has TANGENT and NORMAL; else
  // from TEXCOORD_0, square to the normal; where a primitive has neither any unit vector square to the
  // normal, w 1. Left out where none of the character's primitives has either. Those that are no directions
  // count as not there.
  kTangents = 52,

  kRods = 60,         // RodRecord x rods
  kRodSegments = 61,  // RodSegmentRecord: of all rods, rod after rod
  kJointRods = 62,  // uint32 x joints, where there are rods: the segment in kRodSegments that moves a joint,
                    // its own or its parent's; kNoIndex: none
  kProxies = 63,    // ProxyRecord x proxies
  // Of a character whose rods may start from a learned guess: a COPINGNet, as a model has it.
  kRodNetwork = 64,  // NetworkRecord x 1
  kRodDense = 65,    // DenseRecord x layers
  kRodWeights = 66,  // float, as kWeights
  // Of a character with regions whose patches a network predicts (RegionRecord::cell_m): a DeepEmulator with
  // `moving`, of the character's rate, as a model has it. One level of control graphs.
  kPatchNetwork = 70,   // NetworkRecord x 1
  kPatchDense = 71,     // DenseRecord x layers
  kPatchWeights = 72,   // float, as kWeights
  kPatchMaterial = 73,  // float[3] x nodes: ln k, m, ln (k / m) in ticks, cells and full cells' masses
  kPatchHeld = 74,      // uint8 x nodes: 1 where a node of such a region follows its pose; else 0
};

// kNone: a character of modes alone; no layers, inputs or weights, and of the record only rate_hz
// counts, all else is zero.
// kDeepEmulator, kCopingNet: networks of chains of dense layers; models only, but for a character's
// kPatchNetwork and kRodNetwork.
enum class ModelKind : uint32_t { kNone = 0, kAltConvLstm = 1, kDeepEmulator = 2, kCopingNet = 3 };
inline constexpr const char* kModelNames[] = {"none", "alt_conv_lstm", "deep_emulator", "coping_net"};

// kHalfStates: h, c and P y of the hidden layers are kept as IEEE halves, all arithmetic is float32.
// kInt8: that, and the hidden layers' products but the first one's x are of bytes, summed in 32-bit integers:
//   gate = start + scale[gate] sum_k q_k w[k][gate],  q_k = round(per_unit[k] v_k) within +-127
// where v is what the layer hears, one after the other, each padded to whole 16: P x and x (not in the first
// layer, x only with W_s), P h, P y, and start is the bias, in the first layer and what x gives it. Gate o
// hears P y in a sum of its own. The float tensors are there all the same. Both are of models only.
enum class Precision : uint32_t { kFloat32 = 0, kHalfStates = 1, kInt8 = 2 };
inline constexpr const char* kPrecisionNames[] = {"fp32", "fp16", "int8"};  // as --precision has them

// Alt-ConvLSTM (arXiv 2006.07818 Eq. 5, 9-11) with additions that training needs; each is off in the paper's
// wiring.
//   a   = (P x) W_x + x W_s + (P h) W_h + b       gates i f c o; W_s only where the layer has it
//   i,f = sigmoid(a_if + (P y) W_y_if)
//   c   = clamp(f c + i tanh(a_c), +-state_clamp)
//   y   = (1 - leak) y + c                        hidden layers: leak = hidden_leak
//   y   = (1 - output_leak) y + output_scale c + carry      last layer
//   o   = sigmoid(a_o + (P y) W_y_o)
//   h   = o tanh(c)                               the next layer's x is c
// All but the last layer work in the stated precision; the last is float32.
// carry = X_t - X_{t-1} in the paper's wiring. In a character the network is closed on the modal base:
// y = l, carry = l^ - l_{t-1}, both in length units (tissue/modes/modal_base.hpp).
struct NetworkRecord {
  ModelKind model;
  uint32_t layer_count;   // 1..16; the last layer has 3 channels
  uint32_t input_width;   // floats a node is fed: 9 in the paper's wiring, else the sum of the inputs' widths
  uint32_t max_channels;  // widest layer
  float rate_hz;          // > 0
  float output_scale;     // 1 in the paper's wiring
  float output_leak;      // 0..1
  float hidden_leak;      // 0..1
  float state_clamp;      // bound on |c|; infinity: none
  float length_unit;      // of y: in a character a share of each region's radius, else metres; 1 in the
                          // paper's wiring
  Precision precision;
  uint32_t blocks;  // of kCopingNet, whose latent width is max_channels; else 0
  uint32_t depth;   // of kCopingNet: hidden layers of each chain; else 0
  uint32_t moving;  // of kDeepEmulator, 1: it sees two ticks of patches from where their centre goes on
  uint32_t reserved[2];
};
static_assert(sizeof(NetworkRecord) == 64);

// One tensor after the other in kWeights, layer after layer, without gaps. Channels are padded to `padded`,
// weights lie as pack/weight_layout.hpp says: all rows of all gates of 16 channels, then of the next 16.
// Padding is zero. Offsets count floats, each a multiple of 16. x stands for the layer's input.
struct LayerRecord {
  uint32_t inputs;    // F_in: input_width, then the channels of the layer before
  uint32_t channels;  // F, 1..1024
  uint32_t padded;    // F rounded up to 16
  uint32_t has_self;  // 1: W_s is there
  uint64_t w_x;       // [padded / 16][F_in][4][16]
  uint64_t w_s;       // the same, if has_self; else 0
  uint64_t w_h;       // [padded / 16][F][4][16]
  uint64_t w_y;       // [padded / 16][F][2][16], gates i f; then gate o, [padded / kPanel][F][kPanel]
  uint64_t bias;      // [4][padded]
  uint64_t reserved;
};
static_assert(sizeof(LayerRecord) == 64);

// A dense layer z W + b of a network of chains. In kWeights, layer after layer without gaps: W by panels of
// kPanel outputs, [padded / kPanel][inputs][kPanel], the last panel as wide as what is left; then b [padded].
// Padding is zero. Offsets count floats. Which layers there are, of what size: pack/dense_layout.hpp.
//
// DeepEmulator (CVPR 2021, Eq. 5), tanh between layers; its equations: tissue/network/deep_emulator.hpp.
// COPINGNet (Shao et al. 2021, Sec. 3), max(0, x) between layers; its equations: rods/start/coping_net.hpp.
// Behind its layers stand norm.node and norm.edge, >= 0, 6 numbers each in 16. In their NetworkRecord
// layer_count counts kDense, max_channels is the widest layer (of kCopingNet the latent width; of
// kDeepEmulator gamma's, three times its latent width: 48, 96, 144 or the paper's 192), rate_hz is 0 for
// kCopingNet, the precision is float32, and what is Alt-ConvLSTM's own is 0.
struct DenseRecord {
  uint32_t inputs;
  uint32_t outputs;
  uint32_t padded;  // outputs rounded up to 16
  uint32_t reserved;
  uint64_t w;
  uint64_t bias;
};
static_assert(sizeof(DenseRecord) == 32);

// What a node may be fed, in the order of the kInputs section. Vectors lie along the axes of the node's own
// frame (tissue/frames/node_bend.hpp, node_drive.hpp); l, l^, theta and e as in tissue/modes/modal_base.hpp;
// w1 is first_rad_per_s of the region, a length unit length_unit x radius_m. Numbers 4 to 7 were version 1's.
enum class InputKind : uint32_t {
  kRestPosition = 1,         // 3: bind position less the region's centre, in region radii
  kRestNormal = 2,           // 3: bind normal
  kStiffness = 3,            // 1: painted, 0 soft .. 1 rigid
  kAngularAcceleration = 8,  // 3: of the node's frame, rad/s^2
  kAngularVelocity = 9,      // 3: rad/s
  kGravityChange = 10,       // 3: gravity less gravity in the bind pose, m/s^2
  kDisplacement = 11,        // 3: l of the last tick, length units
  kVelocity = 12,            // 3: l of the last tick less the one before, length units a tick
  kFeltStep = 13,            // 3: e / w1^2, length units
  kBaseStep = 14,            // 3: l^ - l of the last tick, length units
  kTurn = 15,                // 3: theta of the last tick, rad
  kFrequency = 16,           // 1: w1 x tick, rad
  kBend = 17,                // 3: a quarter of the region's bend, rad (tissue/frames/node_bend.hpp)
  kBentForce = 18,           // 3: bend x the value of kFeltStep
  kBentStep = 19,            // 3: bend x the value of kBaseStep
  kBentDisplacement = 20,    // 3: bend x the value of kDisplacement
  kTurnedForce = 21,         // 3: the value of kTurn x that of kFeltStep
  kTurnedStep = 22,          // 3: kTurn x kBaseStep
  kTurnedVelocity = 23,      // 3: kTurn x kVelocity
  kSpunStep = 24,            // 3: kAngularVelocity x kBaseStep
  kSpunVelocity = 25,        // 3: kAngularVelocity x kVelocity
};

struct InputRecord {
  InputKind kind;  // each at most once
  float scale;     // the network is fed value x scale
  float envelope;  // |value x scale| beyond this is clamped and counted; infinity: not bounded
  uint32_t reserved;
};
static_assert(sizeof(InputRecord) == 16);

struct CharacterRecord {
  uint32_t name;  // offset in kStrings
  uint32_t vertex_count, triangle_count, joint_count, region_count, node_count, clip_count;
  float height_m;
  uint32_t rod_count;
  uint32_t proxy_count;    // 0..64
  uint32_t coarser_count;  // 0..3: control graphs of fewer nodes, beside the one that node_count counts
  uint32_t mesh_count;
  float unit_m;  // metres that a unit of the file is, > 0: what the recipe states, or the importer found
  uint32_t reserved[3];
};
static_assert(sizeof(CharacterRecord) == 64);

// A mesh as one node of the file shows it: its vertices, primitive after primitive, in the file's order.
// Meshes follow each other and cover all vertices.
struct MeshRecord {
  uint32_t name;  // of the node
  uint32_t first_vertex, vertex_count;
  float
      mesh_from_bind[12];  // of a place in the bind pose, metres, to the file's own mesh space; row-major 3x4
  uint32_t reserved;
};
static_assert(sizeof(MeshRecord) == 64);

// A primitive of a mesh: what one material paints, and mostly what an engine has in buffers of its own.
// Primitives lie mesh after mesh, in a mesh as in the file; points, lines and what has no POSITION are not
// among them. Together they have all vertices and all triangles.
//   vertices    first_vertex + i is element i of its POSITION accessor, for each i below that one's count: an
//               engine that loads the same file finds all of them so. None is left out, welded, doubled or
//               put elsewhere. Primitives of a mesh all of whose attributes and morph targets are the same
//               accessors share their vertices: the first of them has them, the others name it.
//   triangles   the file's in their order, strips and fans as triangles, but for those without area, which
//               are left out; a mesh that its place in the scene mirrors has the last two corners swapped.
//               All corners lie among its vertices.
struct PrimitiveRecord {
  uint32_t mesh;                        // of kMeshes
  uint32_t material;                    // offset in kStrings of its material's name; kNoIndex: it has none
  uint32_t first_vertex, vertex_count;  // where the primitives before it end, if they are its own
  uint32_t first_triangle, triangle_count;
  uint32_t index;  // among all primitives of its glTF mesh; ascends in a mesh
  // 0: its vertices are its own. Else 1 + the primitive of its mesh, before it, that has them.
  uint32_t sharer;
};
static_assert(sizeof(PrimitiveRecord) == 32);

struct JointRecord {
  uint32_t name;
  uint32_t parent;         // kNoIndex for a root; always smaller than the joint's own index
  float inverse_bind[12];  // joint-from-character in the bind pose, row-major 3x4
  uint32_t reserved[2];
};
static_assert(sizeof(JointRecord) == 64);

inline constexpr uint32_t kInfluences = 8;
struct SkinRecord {
  uint16_t joint[kInfluences];  // unused slots: joint 0, weight 0
  float weight[kInfluences];    // >= 0, descending, sum 1 within 1e-5
};
static_assert(sizeof(SkinRecord) == 48);

// A soft part simulated as one: its nodes are one connected block of the graph and share one set of modes.
struct RegionRecord {
  uint32_t name;
  uint32_t anchor_node;                 // among the region's: where it is held; bend is measured from there
  uint32_t first_node, node_count;      // 1..4096 nodes; 0: a coarser level that leaves the region out
  uint32_t first_vertex, vertex_count;  // in kRegionVertices
  uint64_t carry;                       // float offset in kCarry of [node_count][padded_vertices]
  uint32_t padded_vertices;             // vertex_count rounded up to 16; padding is zero
  float center_m[3];                    // mean of the nodes' bind positions
  float radius_m;                       // largest distance of a node from the centre, > 0
  float displacement_limit_m;           // guard: |l| of every node stays below this, approached smoothly; > 0
  uint32_t touches_body;                // 1: the capsules of kProxies, where an instance asks for it; else 0
  // Above 0: its nodes are corners of voxels of this size, and kPatchNetwork predicts them; else 0.
  float cell_m;
};
static_assert(sizeof(RegionRecord) == 64);

struct NodeRecord {
  float position_m[3];  // bind pose
  float normal[3];      // unit
  float stiffness;      // 0 soft .. 1 rigid
  uint32_t region;
  SkinRecord skin;
};
static_assert(sizeof(NodeRecord) == 80);

inline constexpr uint32_t kMostGraphLevels = 4;  // of control graphs

// A control graph. Each level is a whole one: kRegions, kNodes, kGraphRows, kGraphColumns, kGraphValues,
// kCarry, kRegionModes and kModeMatrices hold one level's part after the other, finest first,
// and what is an index or an offset there counts from the beginning of its level's part. Regions, the
// vertices that each carries, and kModes are the same for all: a level's modes are the finest
// level's, seen at its own nodes, and nodes are held and turned alike. A level's nodes are nodes of the next
// finer one, ascending in kPicks, region by region. In kSpread, level after level of the coarser ones and
// region after region, how their displacement spreads over the next finer level's: [nodes of the
// region][nodes of the finer region, rounded up to 16], padding zero.
struct LevelRecord {
  uint32_t node_count;
  uint32_t graph_entries;  // of kGraphColumns and kGraphValues
  uint64_t carry_floats, matrix_floats;
  uint64_t spread_floats;  // 0 of the finest
};
static_assert(sizeof(LevelRecord) == 32);

inline constexpr uint32_t kMaxModes = 64;  // of a region

// A region's modal base (tissue/modes/modal_base.hpp): q_t = a1 q_{t-1} + a2 q_{t-2} + gain force e, and the
// modes left out as one oscillator, r_t = rest_a1 r_{t-1} + rest_a2 r_{t-2} + rest_gain rest e; l = shape q +
// r. At `matrices`, one after the other without gaps, rows padded with zeros to whole 16, N = 3 node_count:
//   shape, turn   [mode_count][padded]: x y z of the region's nodes a unit of q; turn in rotation vectors
//   response      [N][padded + padded_modes]: what a unit of one number of e brings: rest (s^2), then force
//   project       [N][padded_modes]: q of a unit of one number of l
// where padded_modes is mode_count rounded up to 16.
struct RegionModesRecord {
  uint32_t first_mode, mode_count;  // in kModes; 0..64
  uint64_t matrices;                // float offset in kModeMatrices
  uint32_t padded;                  // N rounded up to 16
  float first_rad_per_s;            // w1, > 0; a region without modes has one too, for its length of time
  float rest_a1, rest_a2;           // stable, as a mode's
  float rest_gain;                  // 1 - rest_a1 - rest_a2
  float first_a1, first_a2;         // of w1, as a mode's: how what is left alone swings on
  uint32_t reserved[5];
};
static_assert(sizeof(RegionModesRecord) == 64);

// a1, a2, gain are for a tick of rate_hz and stable: |a1| < 1 - a2, a2 > -1.
struct ModeRecord {
  float rad_per_s;      // w, > 0
  float damping_ratio;  // zeta, >= 0
  float a1, a2, gain;   // gain = (1 - a1 - a2) / w^2
  uint32_t reserved[3];
};
static_assert(sizeof(ModeRecord) == 32);

// Bones that swing: a chain or tree of segments, the first of which hangs on a bone that no rod moves. A
// character has regions, rods or both.
struct RodRecord {
  uint32_t name;
  uint32_t attach;                        // joint; moved by no rod
  uint32_t first_segment, segment_count;  // 1..65535
  float gravity;                          // 0..100, times the earth's
  float sag;  // 0..1: share of gravity that bends the posed shape; the rest has bent it already in the bind
              // pose
  // 0..pi, what a segment is shown turned against its rest stays below this, approached smoothly; 0: no
  // limit.
  float turn_limit_rad;
  float frequency_hz;          // about that of its slowest swing, for tables; 0: not known
  float gravity_direction[3];  // unit, in the world
  // 0: its end is free. Else 1 + the joint that holds the last segment's end as it held it in the bind pose;
  // moved by no rod, and each segment hangs on the one before.
  uint32_t end_holder;
  uint64_t passed_proxies;  // a bit each of kProxies, which it does not collide with
  uint32_t start;  // what a step's iteration starts from: 0 continued, 1 learned (rods/rod_batch.hpp)
  uint32_t reserved;
};
static_assert(sizeof(RodRecord) == 64);

// A rigid piece of a rod and the joint that holds its beginning (rods/strand.hpp); bind pose, metres. Its
// joint's parent is the joint of the bone that it hangs on.
struct RodSegmentRecord {
  uint32_t joint;   // kNoIndex: a stiff link between a bone's end and a child that begins elsewhere
  uint32_t parent;  // in the rod, before it; kNoIndex for the first alone. A link's is a bone
  float begin_m[3], end_m[3];  // it begins exactly where its parent ends
  float radius_m, density_kg_m3, young_modulus_pa, torsion_modulus_pa;  // > 0
  float damping_s, drag_per_s;                                          // >= 0
  uint32_t reserved[2];
};
static_assert(sizeof(RodSegmentRecord) == 64);

// A capsule about a bone, that rods and regions collide with; bind pose, metres. It moves as its joint does.
struct ProxyRecord {
  uint32_t joint;
  float from_m[3], to_m[3];  // the axis' ends; the same: a sphere
  float radius_m;            // > 0
};
static_assert(sizeof(ProxyRecord) == 32);
inline constexpr uint32_t kMostProxies = 64;  // a bit each in what a rod or a region passes

struct ClipRecord {
  uint32_t name;
  uint32_t first_frame, frame_count;  // frame_count >= 1; the last frame is the clip's end
  float rate_hz;
  uint32_t reserved[4];
};
static_assert(sizeof(ClipRecord) == 32);

// What a tier is worth. Ascending by tier, then by level, then by every; each once at most. With level 0 and
// every 1 there are skinning, extrapolate, modal, and network where the pack has one; what else is there is
// worth having.
// Baked without sinew-trade: costs are the tier's operations at 60 GFLOP/s, and the errors those of this
// character along a few short motions, or not measured.
// Measured: errors over vertices that tissue moves, of extrapolate 4 ticks after the last simulated one.
struct TierRecord {
  uint32_t tier;      // sinew::Tier
  float cost_us;      // a tick and instance on one core, beyond skinning's; corrected online.
                      // skinning: what an instance takes in every step
  float cost_p99_us;  // in one of a hundred of the ticks; NaN: not measured
  float error_mm;     // mean against ground truth; NaN: not measured
  float
      error_ratio;  // a share of skinning's: the median over motions, sinew-trade's of all; NaN: not measured
  float error_p95_mm;       // in one of twenty of the vertices and ticks; NaN: not measured
  uint32_t level;           // of control graphs, 0 the finest; 0 where nothing is simulated
  float worst_error_ratio;  // along the motion in which it is largest; NaN: not measured
  uint32_t worst_clip;      // that motion, of kClips; kNoIndex: no clip of this pack, or not measured
};
static_assert(sizeof(TierRecord) == 36);
// 3 was a model of springs.
constexpr bool is_tier(uint32_t tier) noexcept { return tier < 5 && tier != 3; }

}  // namespace sinew::pack

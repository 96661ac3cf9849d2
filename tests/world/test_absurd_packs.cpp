// test_absurd_packs.cpp  Every number of a pack becomes one that is finite and absurd, or none: it is refused
// with one line, or its character goes on to move finitely.
#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
#include <string>

#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using namespace sinew::test;
using pack::SectionKind;

namespace {

// Where a section's elements have floats, in bytes.
struct Floats {
  SectionKind kind;
  std::vector<size_t> at;
};

std::vector<size_t> each_of(size_t first, size_t count) {
  std::vector<size_t> out;
  for (size_t i = 0; i < count; ++i) out.push_back(first + i * sizeof(float));
  return out;
}

template <class... Lists>
std::vector<size_t> joined(Lists... lists) {
  std::vector<size_t> out;
  (out.insert(out.end(), lists.begin(), lists.end()), ...);
  return out;
}

std::vector<Floats> floats_of_sections() {
  using namespace pack;
  using enum SectionKind;
  const std::vector<size_t> number = {0};
  const std::vector<size_t> network = each_of(offsetof(NetworkRecord, rate_hz), 6);
  const auto skin = [](size_t at) { return each_of(at + offsetof(SkinRecord, weight), kInfluences); };
  return {{kNetwork, network},
          {kRodNetwork, network},
          {kPatchNetwork, network},
          {kInputs, each_of(offsetof(InputRecord, scale), 2)},
          {kCharacter, {offsetof(CharacterRecord, height_m), offsetof(CharacterRecord, unit_m)}},
          {kJoints, each_of(offsetof(JointRecord, inverse_bind), 12)},
          {kSkin, skin(0)},
          {kMeshes, each_of(offsetof(MeshRecord, mesh_from_bind), 12)},
          {kRegions,
           joined(each_of(offsetof(RegionRecord, center_m), 5), each_of(offsetof(RegionRecord, cell_m), 1))},
          {kNodes, joined(each_of(0, 7), skin(offsetof(NodeRecord, skin)))},
          {kRegionModes, each_of(offsetof(RegionModesRecord, first_rad_per_s), 6)},
          {kModes, each_of(0, 5)},
          {kClips, each_of(offsetof(ClipRecord, rate_hz), 1)},
          {kTiers, joined(each_of(offsetof(TierRecord, cost_us), 5),
                          each_of(offsetof(TierRecord, worst_error_ratio), 1))},
          {kRods, joined(each_of(offsetof(RodRecord, gravity), 7))},
          {kRodSegments, each_of(offsetof(RodSegmentRecord, begin_m), 12)},
          {kProxies, each_of(offsetof(ProxyRecord, from_m), 7)},
          {kPositions, number},
          {kNormals, number},
          {kFaceNormals, number},
          {kTangents, number},
          {kGraphValues, number},
          {kCarry, number},
          {kModeMatrices, number},
          {kSpread, number},
          {kClipFrames, number},
          {kWeights, number},
          {kRodWeights, number},
          {kPatchWeights, number},
          {kPatchMaterial, number}};
}

constexpr float kDenormal = std::numeric_limits<float>::denorm_min(),
                kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kAbsurd[] = {0,     -1,   1e-30f, -1e-30f, kDenormal, 1e-9f, 1e-4f, 1,      100,  1e4f,
                             -1e4f, 1e6f, 1e9f,   1e16f,   -1e16f,    1e30f, 3e38f, -3e38f, kInf, kNan};

struct Found {
  size_t refused = 0, played = 0;
  std::string wrong;
};

bool are_finite(std::span<const float> values, float most) {
  return std::ranges::all_of(values, [most](float v) { return std::fabs(v) <= most; });
}

std::string play(World& world, AssetId asset, InstanceId block, int frames) {
  constexpr float kMost = 1e12f;  // of what a joint's own bind matrix may make of a place
  AssetInfo info;
  REQUIRE(world.asset_info(asset, &info).ok());
  std::vector<Matrix34> bind(info.joint_count), joints(info.joint_count);
  REQUIRE(world.bind_pose(asset, bind).ok());
  std::vector<float> places(size_t{3} * info.vertex_count), normals(places);
  for (int f = 0; f < frames; ++f) {
    const float t = static_cast<float>(f) / 60, bend = 0.2f * std::sin(20 * t);
    joints = bind;
    for (size_t j = 1; j < joints.size(); ++j) {
      joints[j].m[0][3] += 0.05f * std::sin(15 * t + static_cast<float>(j));
      for (int k = 0; k < 3; ++k) {
        joints[j].m[0][k] = std::cos(bend) * bind[j].m[0][k] - std::sin(bend) * bind[j].m[1][k];
        joints[j].m[1][k] = std::sin(bend) * bind[j].m[0][k] + std::cos(bend) * bind[j].m[1][k];
      }
    }
    RootTransform root;
    root.position_m[0] = 0.3 * static_cast<double>(std::sin(8 * t));
    if (const Status status = world.set_pose(block, {.joints = joints, .root = root}); !status.ok())
      return std::string("no pose: ") + status.message;
    world.step(f % 4 == 3 ? 1.0f / 100 : 1.0f / 60);
    REQUIRE(world
                .read_positions(block,
                                {.space = Space::kWorld, .out = places.data(), .capacity = info.vertex_count})
                .ok());
    REQUIRE(world.read_normals(block, {.out = normals.data(), .capacity = info.vertex_count}).ok());
    REQUIRE(world.read_joint_matrices(block, joints).ok());
    if (!are_finite(places, kMost)) return "a position in frame " + std::to_string(f);
    if (!are_finite(normals, 1.01f)) return "a normal in frame " + std::to_string(f);
    for (const Matrix34& joint : joints)
      if (!are_finite({&joint.m[0][0], 12}, kMost)) return "a joint in frame " + std::to_string(f);
  }
  InstanceReport report;
  REQUIRE(world.report(block, &report).ok());
  if (!std::isfinite(report.error) || !std::isfinite(report.cost_us) || !std::isfinite(report.planned_us))
    return "a report";
  return {};
}

std::string load_and_play(std::span<const std::byte> bytes, int frames, Found& found) {
  World world;
  REQUIRE(World::create({.max_instances = 1}, &world).ok());
  AssetId asset;
  const Status loaded = world.load_asset(bytes, &asset);
  if (!loaded.ok()) {
    ++found.refused;
    const std::string line = loaded.message;
    return line.size() > 20 && line.find('\n') == std::string::npos ? "" : "no line: " + line;
  }
  ++found.played;
  InstanceId block;
  const Status made = world.create_instance({.asset = asset, .contacts = {.own_body = true}}, &block);
  return made.ok() ? play(world, asset, block, frames) : std::string("no instance: ") + made.message;
}

// Of many elements the first two, the last, and as many between as asked for.
std::vector<size_t> picked(size_t count, size_t between, std::mt19937& random) {
  std::vector<size_t> out;
  for (const size_t i : {size_t{0}, size_t{1}, count - 1})
    if (i < count && std::ranges::count(out, i) == 0) out.push_back(i);
  for (size_t i = 0; i < between && count > 3; ++i) out.push_back(2 + random() % (count - 3));
  return out;
}

// One float of a pack, and what its section's checksum is for.
struct Place {
  pack::SectionEntry* entry;
  size_t element, at;
};

std::vector<Place> places_of(PackEditor& pack, size_t between) {
  std::mt19937 random(5);
  std::vector<Place> out;
  for (const Floats& of : floats_of_sections())
    for (pack::SectionEntry& entry : pack.table())
      if (entry.kind == static_cast<uint32_t>(of.kind) && entry.count > 0)
        for (const size_t element : picked(entry.count, between, random))
          for (const size_t at : of.at) out.push_back({&entry, element, at});
  return out;
}

float put(PackEditor& pack, const Place& place, float value) {
  std::byte* to =
      pack.bytes().data() + place.entry->offset + place.element * place.entry->element_bytes + place.at;
  float was;
  std::memcpy(&was, to, sizeof was);
  std::memcpy(to, &value, sizeof value);
  place.entry->checksum = core::hash64(
      pack.bytes().subspan(place.entry->offset, place.entry->count * place.entry->element_bytes));
  pack.seal_table();
  return was;
}

std::string told(const Place& place, float was, float value) {
  return " section " + std::to_string(place.entry->kind) + " element " + std::to_string(place.element) +
         " byte " + std::to_string(place.at) + " from " + std::to_string(was) + " to " +
         std::to_string(value);
}

void note(const std::string& wrong, const std::string& what, Found& found) {
  if (!wrong.empty() && std::ranges::count(found.wrong, '\n') < 40) found.wrong += "\n" + what + ": " + wrong;
}

void try_each(const std::string& name, PackEditor& pack, size_t between, std::span<const float> values,
              int frames, Found& found) {
  for (const Place& place : places_of(pack, between))
    for (const float value : values) {
      const float was = put(pack, place, value);
      note(load_and_play(pack.bytes(), frames, found), name + told(place, was, value), found);
      put(pack, place, was);
    }
}

// Several at a time, of sizes that may each be good.
void try_together(const std::string& name, PackEditor& pack, int rounds, int frames, Found& found) {
  std::mt19937 random(6);
  const std::vector<Place> places = places_of(pack, 30);
  for (int round = 0; round < rounds; ++round) {
    std::string what = name;
    std::vector<std::pair<Place, float>> changed;
    for (size_t count = 2 + random() % 4; count > 0; --count) {
      const Place& place = places[random() % places.size()];
      const float ten = std::pow(10.0f, std::uniform_real_distribution<float>(-7, 7)(random));
      const float was = put(pack, place, 0), sign = random() % 8 == 0 ? -1.0f : 1.0f;
      const float value = sign * (random() % 2 && was != 0 ? ten * was : ten);
      put(pack, place, value);
      changed.emplace_back(place, was);
      what += told(place, was, value);
    }
    note(load_and_play(pack.bytes(), frames, found), what, found);
    for (size_t i = changed.size(); i-- > 0;) put(pack, changed[i].first, changed[i].second);
  }
}

struct Effort {
  size_t between;  // elements of a section, beside its first and last ones
  std::span<const float> values;
  int rounds, frames;
};

void require_harmless(const Found& found) {
  INFO(found.refused << " refused, " << found.played << " played" << found.wrong);
  CHECK(found.wrong.empty());
  CHECK(found.refused > found.played / 2);
  CHECK(found.played > found.refused / 20);
}

void try_pack(const std::string& name, std::span<const std::byte> bytes, const Effort& effort, Found& found) {
  PackEditor pack(bytes);
  try_each(name, pack, effort.between, effort.values, effort.frames, found);
  try_together(name, pack, effort.rounds, effort.frames, found);
}

void try_small_packs(const Effort& effort) {
  Found found;
  try_pack("character", small_character_pack(), effort, found);
  try_pack("levels", small_levels_pack(), effort, found);
  try_pack("rods", small_rod_pack(), effort, found);
  try_pack("learned", small_learned_pack(), effort, found);
  try_pack("patches", small_patch_pack(), effort, found);
  require_harmless(found);
}

void try_blocks(const Effort& effort) {
  Found found;
  const auto block = [&](const std::string& name, const scenes::BlockOptions& options) {
    try_pack(name, scenes::soft_block(options).bytes(), effort, found);
  };
  block("block with a clip", {.tangents = true, .clip = true});
  block("block of levels", {.nodes = 20, .coarser_nodes = {10, 5}, .leaves_out = true});
  block("block with rods", {.rods = scenes::RodMatter{.sag = 1, .sewn = true, .bar = true}});
  block("block with arms", {.arms = scenes::ArmMatter{}});
  require_harmless(found);
}

}  // namespace

TEST_CASE("numbers_that_are_absurd_are_refused_or_harmless") {
  constexpr float kSome[] = {0, kDenormal, 1e-9f, 1e4f, 1e16f, 3e38f, -3e38f, kNan};
  try_small_packs({.between = 0, .values = kSome, .rounds = 1000, .frames = 12});
}

TEST_CASE("every_number_that_is_absurd_and_many_together_are_refused_or_harmless") {
  try_small_packs({.between = 10, .values = kAbsurd, .rounds = 20000, .frames = 20});
}

TEST_CASE("absurd_numbers_of_blocks_are_refused_or_harmless") {
  try_blocks({.between = 3, .values = kAbsurd, .rounds = 2000, .frames = 20});
}

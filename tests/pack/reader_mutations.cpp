// reader_mutations.cpp  Packs damaged by the thousand: refused, or harmless to all that a runtime reads from
// them. Under the sanitizers this is a fuzz test with a fixed seed.
#include <catch2/catch.hpp>
#include <random>

#include "pack/dense_layout.hpp"
#include "pack/pack_view.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::pack;
using test::PackEditor;

namespace {

const std::vector<std::byte>& character_pack() {
  static const std::vector<std::byte> bytes = test::small_character_pack();
  return bytes;
}

double read_strings(const PackView& view) {
  double sum = 0;
  if (view.character == nullptr) return sum;
  const auto name = [&](uint32_t offset) {
    sum += static_cast<double>(std::strlen(string_at(view, offset)));
  };
  name(view.character->name);
  for (const JointRecord& joint : view.joints) name(joint.name);
  for (const RegionRecord& region : view.regions) name(region.name);
  for (const ClipRecord& clip : view.clips) name(clip.name);
  for (const PrimitiveRecord& primitive : view.primitives)
    if (primitive.material != kNoIndex) name(primitive.material);
  return sum;
}

double read_mesh(const PackView& view) {
  double sum = 0;
  for (uint32_t vertex : view.triangles) sum += view.positions[3 * vertex + 2];
  for (uint32_t vertex : view.welded) sum += view.normals[3 * vertex + 2] + view.colors[4 * vertex + 3];
  for (const SkinRecord& skin : view.skin)
    for (uint16_t joint : skin.joint) sum += view.joints[joint].inverse_bind[11];
  for (const ClipRecord& clip : view.clips)
    sum += view.clip_frames[(clip.first_frame + clip.frame_count) * 12 * view.joints.size() - 1];
  return sum;
}

double read_primitives(const PackView& view) {
  double sum = 0;
  for (const PrimitiveRecord& p : view.primitives) {
    if (p.vertex_count > 0) sum += view.positions[3 * (size_t{p.first_vertex} + p.vertex_count) - 1];
    if (p.triangle_count > 0) sum += view.triangles[3 * (size_t{p.first_triangle} + p.triangle_count) - 1];
    sum += view.meshes[p.mesh].mesh_from_bind[0];
    if (p.sharer > 0) sum += view.primitives[p.sharer - 1].index;
  }
  for (size_t v = 0; 4 * v < view.tangents.size(); ++v)
    sum += view.tangents[4 * v + 3] * view.positions[3 * v];
  return sum;
}

double read_regions(const PackView& view) {
  double sum = 0;
  for (const RegionRecord& region : view.regions) {
    sum += view.nodes[region.first_node + region.node_count - 1].stiffness;
    sum += view.carry[region.carry + uint64_t{region.node_count} * region.padded_vertices - 1];
    for (uint32_t k = 0; k < region.vertex_count; ++k)
      sum += view.positions[3 * view.region_vertices[region.first_vertex + k]];
  }
  for (size_t node = 0; node < view.nodes.size(); ++node)
    for (uint32_t at = view.graph_rows[node]; at < view.graph_rows[node + 1]; ++at)
      sum += view.graph_values[at] * view.nodes[view.graph_columns[at]].stiffness;
  return sum;
}

double read_modes(const PackView& view) {
  double sum = 0;
  for (size_t r = 0; r < view.regions.size(); ++r) {
    const RegionModesRecord& modes = view.region_modes[r];
    const uint64_t floats =
        uint64_t{2} * modes.mode_count * modes.padded +
        uint64_t{3} * view.regions[r].node_count * (modes.padded + 2 * round_up_16(modes.mode_count));
    if (floats > 0) sum += view.mode_matrices[modes.matrices + floats - 1];
    for (uint32_t k = 0; k < modes.mode_count; ++k) sum += view.modes[modes.first_mode + k].gain;
    sum += view.region_modes[r].first_a1;
  }
  return sum;
}

double read_network(const PackView& view) {
  double sum = 0;
  for (const LayerRecord& layer : view.layers) {
    sum += view.weights[layer.w_x + uint64_t{layer.inputs} * 4 * layer.padded - 1];
    sum += view.weights[layer.w_h + uint64_t{layer.channels} * 4 * layer.padded - 1];
    sum += view.weights[layer.bias + uint64_t{4} * layer.padded - 1];
  }
  for (const DenseRecord& layer : view.dense) {
    sum += view.weights[layer.w + weight_at(layer, layer.inputs - 1, layer.padded - 1)];
    sum += view.weights[layer.bias + layer.padded - 1];
  }
  for (const DenseRecord& layer : view.rod_network.layers) {
    sum += view.rod_network.weights[layer.w + weight_at(layer, layer.inputs - 1, layer.padded - 1)];
    sum += view.rod_network.weights[layer.bias + layer.padded - 1];
  }
  return sum;
}

double read_rods(const PackView& view) {
  double sum = 0;
  for (const RodRecord& rod : view.rods) {
    sum += view.joints[rod.attach].inverse_bind[11];
    sum += static_cast<double>(std::strlen(string_at(view, rod.name)));
    for (const RodSegmentRecord& s : view.rod_segments.subspan(rod.first_segment, rod.segment_count)) {
      if (s.parent != kNoIndex) sum += view.rod_segments[rod.first_segment + s.parent].end_m[0];
      if (s.joint != kNoIndex) sum += view.joint_rods[s.joint];
    }
  }
  for (const ProxyRecord& p : view.proxies) sum += view.joints[p.joint].inverse_bind[0] * p.radius_m;
  for (const uint32_t carrier : view.joint_rods)
    if (carrier != kNoIndex) sum += view.rod_segments[carrier].radius_m;
  return sum;
}

double read_levels(const PackView& view) {
  double sum = 0;
  for (uint32_t l = 1; l < view.level_count; ++l) {
    const PackView coarse = at_level(view, l), fine = at_level(view, l - 1);
    sum += read_regions(coarse) + read_modes(coarse);
    for (const uint32_t pick : coarse.picks) sum += fine.nodes[pick].stiffness;
    size_t floats = 0;
    for (size_t r = 0; r < fine.regions.size(); ++r)
      floats += coarse.regions[r].node_count * round_up_16(fine.regions[r].node_count);
    sum += coarse.spread[floats - 1];
  }
  return sum;
}

// Reads everything that indexes something, as the runtime would. Spans are not checked: the sanitizers are.
double read_all(const PackView& view) {
  return read_strings(view) + read_mesh(view) + read_primitives(view) + read_regions(view) +
         read_modes(view) + read_network(view) + read_rods(view) + read_levels(view);
}

// Whether the damaged pack is taken; one that is must be safe to read.
bool taken(PackEditor& editor) {
  PackView view;
  const Status status = editor.open(&view);
  if (!status.ok()) {
    REQUIRE(std::strlen(status.message) > 0);
    REQUIRE(view.network == nullptr);
    return false;
  }
  volatile double sum = read_all(view);
  static_cast<void>(sum);
  return true;
}

void check_hostile_words(const std::vector<std::byte>& pack) {
  constexpr uint32_t kHostile[] = {0,          1,          2,          3,          0x7fffffff,
                                   0x80000000, 0xffffffff, 0x7fc00000, 0x7f800000, 0xffc0};
  size_t taken_count = 0;
  for (size_t at = 0; at + 4 <= pack.size(); at += 4)
    for (uint32_t value : kHostile) {
      PackEditor editor(pack);
      const size_t sections = editor.table()[0].offset;
      std::memcpy(editor.bytes().data() + at, &value, sizeof value);
      if (at >= sections) editor.seal();
      if (at >= sizeof(FileHeader) && at < sections) editor.seal_table();
      taken_count += taken(editor) ? 1 : 0;
    }
  CHECK(taken_count > 0);  // a weight of 1 is a good weight: the content was reached
}

void check_random_damage(const std::vector<std::byte>& pack) {
  constexpr int kRounds = 20000;
  std::mt19937 random(11);
  size_t taken_count = 0, refused_count = 0;
  for (int round = 0; round < kRounds; ++round) {
    PackEditor editor(pack);
    const std::span<std::byte> content = editor.bytes().subspan(editor.table()[0].offset);
    for (auto edits = 1 + random() % 3; edits > 0; --edits)
      content[random() % content.size()] = static_cast<std::byte>(random());
    editor.seal();
    ++(taken(editor) ? taken_count : refused_count);
  }
  CHECK(taken_count > 0);
  CHECK(refused_count > 0);
}

}  // namespace

TEST_CASE("every_truncation_is_refused") {
  size_t taken_count = 0;
  for (size_t size = 0; size < character_pack().size(); ++size) {
    PackEditor editor({character_pack().data(), size});  // a block of exactly this size
    taken_count += taken(editor) ? 1 : 0;
  }
  CHECK(taken_count == 0);
}

// Every bit of header and table, and one of each byte behind them: the checksums' own test has the rest.
TEST_CASE("flipped_bits_are_refused") {
  PackEditor editor(character_pack());
  REQUIRE(taken(editor));
  const size_t sections = editor.table()[0].offset;
  size_t taken_count = 0;
  for (size_t byte = 0; byte < editor.bytes().size(); ++byte)
    for (size_t bit = 0; bit < (byte < sections ? 8u : 1u); ++bit) {
      const auto mask = static_cast<std::byte>(1u << (byte + bit) % 8);
      editor.bytes()[byte] ^= mask;
      taken_count += taken(editor) ? 1 : 0;
      editor.bytes()[byte] ^= mask;
    }
  CHECK(taken_count == 0);
}

// Every 4-byte word of header, table and sections takes values that break arithmetic, with all checksums
// right.
TEST_CASE("hostile_words_with_right_checksums_are_refused_or_harmless") {
  check_hostile_words(character_pack());
  check_hostile_words(test::small_chain_model());
  check_hostile_words(test::small_rod_pack());
  check_hostile_words(test::small_learned_pack());
  check_hostile_words(test::small_levels_pack());
}

TEST_CASE("random_damage_with_right_checksums_is_refused_or_harmless") {
  check_random_damage(character_pack());
  check_random_damage(test::small_chain_model());
  check_random_damage(test::small_rod_pack());
  check_random_damage(test::small_learned_pack());
  check_random_damage(test::small_levels_pack());
}

TEST_CASE("random_tables_with_right_checksums_are_refused_or_harmless") {
  constexpr int kRounds = 20000;
  std::mt19937_64 random(12);
  for (int round = 0; round < kRounds; ++round) {
    PackEditor editor(character_pack());
    SectionEntry& entry = editor.table()[random() % editor.table().size()];
    const uint64_t small = random() % 4096, wild = random();
    switch (random() % 5) {
      case 0:
        entry.count = random() % 2 ? small : wild;
        break;
      case 1:
        entry.offset = random() % 2 ? small : wild;
        break;
      case 2:
        entry.element_bytes = static_cast<uint32_t>(random() % 2 ? small : wild);
        break;
      case 3:
        entry.kind = static_cast<uint32_t>(random() % 64);
        break;
      default:
        std::swap(entry, editor.table()[random() % editor.table().size()]);
    }
    // A changed count must not be caught by the checksum alone.
    if (entry.offset <= editor.bytes().size() && entry.element_bytes > 0 &&
        entry.count <= (editor.bytes().size() - entry.offset) / entry.element_bytes)
      entry.checksum = core::hash64(editor.bytes().subspan(entry.offset, entry.count * entry.element_bytes));
    editor.seal_table();
    taken(editor);
  }
  SUCCEED("no read outside the bytes");
}

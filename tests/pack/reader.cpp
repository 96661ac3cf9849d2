// reader.cpp  What the reader refuses, why, and that it takes nothing and touches nothing while it does.
#include "pack/reader.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "baker/pack/character/character_pack.hpp"
#include "baker/pack/network/dense_pack.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "pack/dense_layout.hpp"
#include "tests/pack/count_allocations.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::pack;
using Catch::Contains;
using test::PackEditor;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

const std::vector<std::byte>& character_pack() {
  static const std::vector<std::byte> bytes = test::small_character_pack();
  return bytes;
}

// A change that makes a good pack bad, and a word of the message that names it.
struct Damage {
  const char* word;
  std::function<void(PackEditor&)> apply;
  StatusCode code = StatusCode::kCorrupt;
};

// The change of one element.
template <class T, class Change>
std::function<void(PackEditor&)> change(SectionKind kind, size_t index, Change apply) {
  return [=](PackEditor& editor) { apply(editor.section<T>(kind)[index]); };
}

template <class T>
std::function<void(PackEditor&)> set(SectionKind kind, size_t index, T value) {
  return change<T>(kind, index, [=](T& element) { element = value; });
}

void check_refused(std::span<const std::byte> good, const std::vector<Damage>& damages) {
  for (const Damage& damage : damages) {
    PackEditor editor(good);
    damage.apply(editor);
    editor.seal();
    const Status status = editor.open();
    INFO("wanted: " << damage.word << ", message: " << status.message);
    CHECK(status.code == damage.code);
    CHECK_THAT(status.message, Contains(damage.word));
  }
}

}  // namespace

TEST_CASE("what_is_not_a_whole_pack_of_this_version_is_refused_with_its_cause") {
  PackView view;
  CHECK(open_pack({}, &view).code == StatusCode::kNotAPack);

  PackEditor editor(character_pack());
  CHECK(open_pack(editor.bytes().subspan(1), &view).code == StatusCode::kInvalidArgument);
  CHECK(open_pack(editor.bytes().first(5), &view).code == StatusCode::kNotAPack);
  CHECK(open_pack(editor.bytes().first(63), &view).code == StatusCode::kTruncated);
  CHECK(open_pack(editor.bytes().first(editor.bytes().size() - 1), &view).code == StatusCode::kTruncated);

  editor.header().magic[0] = 'X';
  CHECK(editor.open(&view).code == StatusCode::kNotAPack);
  CHECK(view.network == nullptr);
}

TEST_CASE("another_version_names_the_command_that_rebakes_it") {
  PackEditor character(character_pack()), model(test::small_model());
  character.header().version = 0;
  model.header().version = 1;
  CHECK(character.open().code == StatusCode::kWrongVersion);
  CHECK_THAT(character.open().message,
             Contains("version 0") && Contains("sinew-bake character IN.glb --recipe R.json --tissue"));
  CHECK_THAT(model.open().message,
             Contains("version 1 ") && Contains("sinew-bake model W.safetensors -o M.sinew"));
}

TEST_CASE("header_and_table_faults_are_refused_by_name") {
  const auto entry = [](auto apply) { return [=](PackEditor& e) { apply(e.table()[1]); }; };
  const Damage damages[] = {
      {"neither model nor character", [](PackEditor& e) { e.header().kind = FileKind{7}; }},
      {"reserved", [](PackEditor& e) { e.header().reserved[2] = 1; }},
      {"reserved", [](PackEditor& e) { e.header().reserved0 = 1; }},
      {"more than 64", [](PackEditor& e) { e.header().section_count = 65; }},
      {"ascend", [](PackEditor& e) { e.table()[1].kind = e.table()[0].kind; }},
      {"wrong size", entry([](SectionEntry& s) { s.element_bytes = 2; })},
      {"not where", entry([](SectionEntry& s) { s.offset += 64; })},
      {"not where", entry([](SectionEntry& s) { s.offset -= 1; })},
      {"beyond the end", entry([](SectionEntry& s) { s.count = uint64_t{1} << 62; })},
      {"beyond the end", entry([](SectionEntry& s) { s.count = ~uint64_t{0}; })},
      {"does not belong into a model", [](PackEditor& e) { e.header().kind = FileKind::kModel; }},
      {"checksum", entry([](SectionEntry& s) { s.checksum ^= 1; })},
  };
  for (const Damage& damage : damages) {
    PackEditor editor(character_pack());
    damage.apply(editor);
    if (editor.header().section_count <= 64) editor.seal_table();
    INFO("wanted: " << damage.word << ", message: " << editor.open().message);
    CHECK(editor.open().code == StatusCode::kCorrupt);
    CHECK_THAT(editor.open().message, Contains(damage.word));
  }
}

TEST_CASE("a_precision_that_is_not_known_or_not_that_of_the_sections_is_refused") {
  using enum SectionKind;
  const auto precision = [](Precision value) {
    return change<NetworkRecord>(kNetwork, 0, [=](NetworkRecord& n) { n.precision = value; });
  };
  baker::PackWriter writer(FileKind::kModel);
  baker::add_network(test::small_paper_weights(), writer, Precision::kInt8, test::small_paper_ranges());
  check_refused(writer.finish(),
                {{"precision 3 is not known", precision(Precision{3}), StatusCode::kUnsupported},
                 {"int8 sections of a network in fp32", precision(Precision::kFloat32)},
                 {"int8 sections of a network in fp16", precision(Precision::kHalfStates)}});
}

TEST_CASE("a_character_in_another_precision_names_the_command_that_rebakes_it") {
  for (const Precision precision : {Precision::kHalfStates, Precision::kInt8}) {
    const auto is_reduced = [=](NetworkRecord& n) { n.precision = precision; };
    PackEditor editor(character_pack());
    change<NetworkRecord>(SectionKind::kNetwork, 0, is_reduced)(editor);
    editor.seal();
    const Status status = editor.open();
    CHECK(status.code == StatusCode::kUnsupported);
    CHECK_THAT(status.message, Contains(kPrecisionNames[static_cast<uint32_t>(precision)]) &&
                                   Contains("fp32 only; bake it again with sinew-bake character"));
  }
}

TEST_CASE("faults_of_a_network_of_chains_are_refused_by_name") {
  using enum SectionKind;
  const std::vector<std::byte> model = test::small_chain_model();
  REQUIRE(PackEditor(model).open().ok());
  const auto network = [](auto apply) { return change<NetworkRecord>(kNetwork, 0, apply); };
  const auto layer = [](auto apply) { return change<DenseRecord>(kDense, 3, apply); };
  const auto weight = [](auto place, float value) -> std::function<void(PackEditor&)> {
    return [=](PackEditor& editor) {
      const DenseRecord& of = editor.section<DenseRecord>(kDense)[3];
      editor.section<float>(kWeights)[place(of)] = value;
    };
  };
  const size_t numbers = PackEditor(model).section<float>(kWeights).size();
  check_refused(
      model, {{"precision 2 of a model coping_net, which this build runs in fp32 only",
               network([](auto& n) { n.precision = Precision::kInt8; }), StatusCode::kUnsupported},
              {"fields of an alt_conv_lstm", network([](auto& n) { n.input_width = 9; })},
              {"fields of an alt_conv_lstm", network([](auto& n) { n.state_clamp = 1; })},
              {"latent width 0", network([](auto& n) { n.max_channels = 0; })},
              {"latent width 257", network([](auto& n) { n.max_channels = 257; })},
              {"17 blocks", network([](auto& n) { n.blocks = 17; })},
              {"0 blocks", network([](auto& n) { n.blocks = 0; })},
              {"depth 0", network([](auto& n) { n.depth = 0; })},
              {"depth 9", network([](auto& n) { n.depth = 9; })},
              {"a rate", network([](auto& n) { n.rate_hz = 60; })},
              {"reserved", network([](auto& n) { n.reserved[0] = 1; })},
              {"16 dense layers stated, 16 there, 12 wanted", network([](auto& n) { n.blocks = 1; })},
              {"15 dense layers stated", network([](auto& n) { n.layer_count = 15; })},
              {"deep_emulator has not", network([](auto& n) { n.model = ModelKind::kDeepEmulator; })},
              {"dense layer 0: 14 inputs and 5 outputs, wanted 14 and 6",
               network([](auto& n) { n.max_channels = 6; })},
              {"dense layer 3: 6 inputs", layer([](auto& l) { l.inputs = 6; })},
              {"dense layer 3: 5 inputs and 4 outputs", layer([](auto& l) { l.outputs = 4; })},
              {"dense layer 3: outputs padded to 32", layer([](auto& l) { l.padded = 32; })},
              {"dense layer 3: reserved", layer([](auto& l) { l.reserved = 1; })},
              {"dense layer 3: its weights are not where", layer([](auto& l) { l.w += 16; })},
              {"dense layer 3: its weights are not where", layer([](auto& l) { l.bias = ~uint64_t{0}; })},
              {"dense layer 3: padding", weight([](const auto& l) { return l.w + weight_at(l, 2, 5); }, 1)},
              {"dense layer 3: padding", weight([](const auto& l) { return l.bias + 15; }, 1)},
              {"not finite", weight([](const auto& l) { return l.w; }, kNan)},
              {"a norm is below zero", set<float>(kWeights, numbers - 32, -1.0f)},
              {"a norm is below zero", set<float>(kWeights, numbers - 1, 1.0f)},
              {"not finite", set<float>(kWeights, numbers - 16, kInfinity)}});
}

TEST_CASE("networks_of_chains_with_sections_of_another_network_or_of_the_wrong_length_are_refused") {
  using enum SectionKind;
  PackEditor good(test::small_chain_model());
  const std::span<float> weights = good.section<float>(kWeights);
  const auto changed = [&](const std::function<void(baker::PackWriter&)>& change) {
    baker::PackWriter writer(FileKind::kModel);
    baker::add_chains(test::small_coping_net(), writer);
    change(writer);
    return writer.finish();
  };
  const auto refuse = [&](const char* word, const std::function<void(baker::PackWriter&)>& change) {
    check_refused(changed(change), {{word, [](PackEditor&) {}}});
  };
  refuse("int8 weights of an alt_conv_lstm",
         [](auto& w) { w.section(kInputs, std::vector<InputRecord>(1)); });
  refuse("int8 weights of an alt_conv_lstm",
         [](auto& w) { w.section(kLayers, std::vector<LayerRecord>(1)); });
  refuse("int8 weights of an alt_conv_lstm", [](auto& w) { w.section(kInt8Sums, std::vector<int32_t>(1)); });
  refuse("dense layers stated, 15 there", [&](auto& w) {
    const std::span<DenseRecord> dense = good.section<DenseRecord>(kDense);
    w.section(kDense, std::vector(dense.begin(), dense.end() - 1));
  });
  refuse("31 numbers behind the layers",
         [&](auto& w) { w.section(kWeights, std::vector(weights.begin(), weights.end() - 1)); });
  refuse("reach beyond the section",
         [&](auto& w) { w.section(kWeights, std::vector(weights.begin(), weights.begin() + 100)); });
  baker::PackWriter writer(FileKind::kModel);
  baker::add_network(test::small_paper_weights(), writer);
  writer.section(kDense, std::vector<DenseRecord>(1));
  check_refused(writer.finish(), {{"which an alt_conv_lstm has not", [](PackEditor&) {}}});
}

TEST_CASE("faults_of_a_deep_emulator_are_refused_by_name") {
  using enum SectionKind;
  baker::PackWriter writer(FileKind::kModel);
  baker::add_chains(test::small_deep_emulator(), writer);
  const std::vector<std::byte> model = writer.finish();
  REQUIRE(PackEditor(model).open().ok());
  const auto network = [](auto apply) { return change<NetworkRecord>(kNetwork, 0, apply); };
  check_refused(model, {{"widest layer", network([](auto& n) { n.max_channels = 191; })},
                        {"widest layer", network([](auto& n) { n.max_channels = 96 + 16; })},
                        {"moving", network([](auto& n) { n.moving = 2; })},
                        {"rate", network([](auto& n) { n.rate_hz = 0; })},
                        {"rate", network([](auto& n) { n.rate_hz = -1; })},
                        {"rate", network([](auto& n) { n.rate_hz = kNan; })},
                        {"blocks", network([](auto& n) { n.blocks = 1; })}});
}

TEST_CASE("network_faults_are_refused_by_name") {
  using enum SectionKind;
  const auto network = [](auto apply) { return change<NetworkRecord>(kNetwork, 0, apply); };
  const auto input = [](auto apply) { return change<InputRecord>(kInputs, 1, apply); };
  const auto layer = [](auto apply) { return change<LayerRecord>(kLayers, 1, apply); };
  const auto set_channels = [](uint32_t channels) {
    return change<LayerRecord>(kLayers, 0, [=](LayerRecord& l) { l.channels = channels; });
  };
  check_refused(
      character_pack(),
      {{"model 9 is not known", network([](auto& n) { n.model = ModelKind{9}; }), StatusCode::kUnsupported},
       {"precision 9 is not known", network([](auto& n) { n.precision = Precision{9}; }),
        StatusCode::kUnsupported},
       {"layers stated", network([](auto& n) { n.layer_count = 3; })},
       {"input width", network([](auto& n) { n.input_width = 33; })},
       {"outside 1..1024", network([](auto& n) { n.input_width = 0; })},
       {"widest layer", network([](auto& n) { n.max_channels = 6; })},
       {"rate", network([](auto& n) { n.rate_hz = 0; })},
       {"rate", network([](auto& n) { n.rate_hz = kNan; })},
       {"output scale", network([](auto& n) { n.output_scale = kInfinity; })},
       {"leak", network([](auto& n) { n.output_leak = 1.5f; })},
       {"leak", network([](auto& n) { n.hidden_leak = kNan; })},
       {"state clamp", network([](auto& n) { n.state_clamp = 0; })},
       {"length unit", network([](auto& n) { n.length_unit = -1; })},
       {"reserved", network([](auto& n) { n.reserved[1] = 1; })},
       {"moving", network([](auto& n) { n.moving = 1; })},
       {"dense layers, which an alt_conv_lstm has not", network([](auto& n) { n.blocks = 1; })},
       {"dense layers, which an alt_conv_lstm has not", network([](auto& n) { n.depth = 1; })},
       {"model deep_emulator, which this build runs in models only",
        network([](auto& n) { n.model = ModelKind::kDeepEmulator; }), StatusCode::kUnsupported},
       {"input 1: kind 26", input([](auto& i) { i.kind = InputKind{26}; })},
       {"input 1: kind 4", input([](auto& i) { i.kind = InputKind{4}; })},
       {"input 1: its kind appears twice", input([](auto& i) { i.kind = InputKind::kRestPosition; })},
       {"input 1: scale", input([](auto& i) { i.scale = kNan; })},
       {"input 1: envelope", input([](auto& i) { i.envelope = 0; })},
       {"input 1: reserved", input([](auto& i) { i.reserved = 1; })},
       {"layer 1: 6 inputs", layer([](auto& l) { l.inputs = 6; })},
       {"layer 0: 0 channels", set_channels(0)},
       {"layer 0: 4000 channels", set_channels(4000)},
       {"layer 1: channels padded", layer([](auto& l) { l.padded = 32; })},
       {"not 3", layer([](auto& l) { l.channels = 4; })},
       {"layer 1: has_self", layer([](auto& l) { l.has_self = 2; })},
       {"layer 1: an offset of self weights", layer([](auto& l) { l.has_self = 0; })},
       {"layer 1: a tensor is not where", layer([](auto& l) { l.w_h += 16; })},
       {"layer 1: a tensor is not where", layer([](auto& l) { l.bias = ~uint64_t{0}; })},
       {"layer 1: reserved", layer([](auto& l) { l.reserved = 1; })},
       {"layer 0: padding", set<float>(kWeights, 5, 1.0f)},
       {"number 0 is not finite", set<float>(kWeights, 0, kNan)}});
}

TEST_CASE("character_faults_are_refused_by_name") {
  using enum SectionKind;
  const auto record = [](auto apply) { return change<CharacterRecord>(kCharacter, 0, apply); };
  const auto joint = [](auto apply) { return change<JointRecord>(kJoints, 1, apply); };
  const auto skin = [](auto apply) { return change<SkinRecord>(kSkin, 3, apply); };
  const auto clip = [](auto apply) { return change<ClipRecord>(kClips, 0, apply); };
  check_refused(character_pack(),
                {{"no vertices", record([](auto& c) { c.vertex_count = 0; })},
                 {"positions", record([](auto& c) { c.vertex_count = 13; })},
                 {"positions", record([](auto& c) { c.vertex_count = 0xffffffff; })},
                 {"triangles", record([](auto& c) { c.triangle_count += 1; })},
                 {"joints", record([](auto& c) { c.joint_count = 65536; })},
                 {"joints", record([](auto& c) { c.joint_count = 2; })},
                 {"regions", record([](auto& c) { c.region_count = 1; })},
                 {"nodes", record([](auto& c) { c.node_count = 4; })},
                 {"clips", record([](auto& c) { c.clip_count = 0; })},
                 {"height", record([](auto& c) { c.height_m = kNan; })},
                 {"unit of the character's file is 0 m", record([](auto& c) { c.unit_m = 0; })},
                 {"unit of the character's file is nan", record([](auto& c) { c.unit_m = kNan; })},
                 {"unit of the character's file is inf", record([](auto& c) { c.unit_m = kInfinity; })},
                 {"name lies outside", record([](auto& c) { c.name = 100000; })},
                 {"character 0: reserved", record([](auto& c) { c.reserved[0] = 1; })},
                 {"joint 1: its name", joint([](auto& j) { j.name = kNoIndex; })},
                 {"joint 1: parent 1", joint([](auto& j) { j.parent = 1; })},
                 {"joint 1: inverse bind", joint([](auto& j) { j.inverse_bind[7] = kInfinity; })},
                 {"positions: number 4", set<float>(kPositions, 4, kNan)},
                 {"vertex 2: normal", set<float>(kNormals, 7, 1.5f)},
                 {"triangle 1: vertex 12 of 12", set<uint32_t>(kTriangles, 5, 12u)},
                 {"vertex 3: skinned to joint 3", skin([](auto& s) { s.joint[1] = 3; })},
                 {"vertex 3: skin weights sum", skin([](auto& s) { s.weight[0] = 0.8f; })},
                 {"vertex 3: skin weights are not descending", skin([](auto& s) { s.weight[0] = 0.1f; })},
                 {"vertex 3: skin weights are not descending", skin([](auto& s) { s.weight[1] = kNan; })},
                 {"vertex 3: skin weights are not descending", skin([](auto& s) { s.weight[7] = -0.5f; })},
                 {"vertex 3: a joint without", skin([](auto& s) { s.joint[7] = 1; })},
                 {"vertex 5: welded to 6", set<uint32_t>(kWelded, 5, 6u)},
                 {"clip 0: frames", clip([](auto& c) { c.first_frame = 1; })},
                 {"clip 0: frames", clip([](auto& c) { c.frame_count = 0; })},
                 {"clip frames", clip([](auto& c) { c.frame_count = 0xffffffff; })},
                 {"clip 0: rate", clip([](auto& c) { c.rate_hz = -60; })},
                 {"clip frames: number 30", set<float>(kClipFrames, 30, kNan)},
                 {"strings", [](PackEditor& e) { e.section<char>(kStrings).back() = 'x'; }}});
}

// Two primitives of one mesh share its 12 vertices and have 8 triangles each; their indices are 0 and 2.
TEST_CASE("primitive_faults_are_refused_by_name") {
  using enum SectionKind;
  const auto primitive = [](size_t index, auto apply) {
    return change<PrimitiveRecord>(kPrimitives, index, [=](PrimitiveRecord& p) { apply(p); });
  };
  const auto both = [=](auto apply) -> std::function<void(PackEditor&)> {
    return [=](PackEditor& editor) {
      for (size_t index : {0, 1}) primitive(index, apply)(editor);
    };
  };
  check_refused(
      character_pack(),
      {{"primitive 1: mesh 1 of 1", primitive(1, [](auto& p) { p.mesh = 1; })},
       {"primitive 0: mesh 4294967295 of 1", primitive(0, [](auto& p) { p.mesh = kNoIndex; })},
       {"primitive 1: index 0 does not ascend", primitive(1, [](auto& p) { p.index = 0; })},
       {"primitive 0: its material's name", primitive(0, [](auto& p) { p.material = 100000; })},
       {"primitive 1: its material's name", primitive(1, [](auto& p) { p.material = kNoIndex - 1; })},
       {"primitive 0: its vertices do not follow", primitive(0, [](auto& p) { p.first_vertex = 1; })},
       {"primitive 1: its vertices do not follow", primitive(1, [](auto& p) { p.sharer = 0; })},
       {"primitive 0: its vertices lie outside of mesh 0",
        primitive(0, [](auto& p) { p.vertex_count = 13; })},
       {"primitive 0: its vertices lie outside of mesh 0",
        primitive(0, [](auto& p) { p.vertex_count = 0xffffffff; })},
       {"primitive 0: shares with 0", primitive(0, [](auto& p) { p.sharer = 1; })},
       {"primitive 1: shares with 1", primitive(1, [](auto& p) { p.sharer = 2; })},
       {"primitive 1: its vertices are not those of primitive 0",
        primitive(1, [](auto& p) { p.first_vertex = 4; })},
       {"primitive 1: its vertices are not those of primitive 0",
        primitive(1, [](auto& p) { p.vertex_count = 11; })},
       {"primitive 0: its triangles do not follow", primitive(0, [](auto& p) { p.first_triangle = 1; })},
       {"primitive 1: its triangles do not follow", primitive(1, [](auto& p) { p.first_triangle = 7; })},
       {"primitive 1: its triangles are more", primitive(1, [](auto& p) { p.triangle_count = 9; })},
       {"primitive 0: its triangles are more", primitive(0, [](auto& p) { p.triangle_count = 0xffffffff; })},
       {"primitives: have 12 vertices and 15 triangles, the character 12 and 16",
        primitive(1, [](auto& p) { p.triangle_count = 7; })},
       {"primitive 1: a triangle has a vertex that is not its own",
        both([](auto& p) { p.vertex_count = 8, p.triangle_count = p.index == 0 ? 8 : 1; })}});
}

TEST_CASE("primitives_that_share_across_meshes_or_lie_in_another_s_are_refused_by_name") {
  using enum SectionKind;
  baker::Character character = test::small_character();
  character.meshes = {{.vertex_count = 4}, {.first_vertex = 4, .vertex_count = 8}};
  character.triangles = {{0, 1, 2}, {4, 5, 6}, {8, 9, 10}};
  character.primitives = {
      {.vertex_count = 4, .triangle_count = 1},
      {.mesh = 1, .first_vertex = 4, .vertex_count = 8, .first_triangle = 1, .triangle_count = 1},
      {.mesh = 1,
       .first_vertex = 4,
       .vertex_count = 8,
       .first_triangle = 2,
       .triangle_count = 1,
       .index = 1,
       .sharer = 1}};
  const baker::TissueLayout layout = test::small_layout(character);
  const std::vector<std::byte> good = baker::pack_character(character, layout, test::small_modes(layout));
  REQUIRE(PackEditor(good).open().ok());
  const auto primitive = [](size_t index, auto apply) {
    return change<PrimitiveRecord>(kPrimitives, index, [=](PrimitiveRecord& p) { apply(p); });
  };
  check_refused(
      good, {{"primitive 1: its vertices lie outside of mesh 0",
              primitive(1, [](auto& p) { p.mesh = 0, p.index = 1; })},
             {"primitive 2: its mesh comes before", primitive(2, [](auto& p) { p.mesh = 0; })},
             {"primitive 0: its vertices lie outside of mesh 1", primitive(0, [](auto& p) { p.mesh = 1; })},
             {"primitive 2: its vertices are not those of primitive 0",
              primitive(2, [](auto& p) { p.sharer = 1; })},
             {"primitive 2: its vertices are not those of primitive 0",
              primitive(2, [](auto& p) { p.sharer = 1, p.first_vertex = 0, p.vertex_count = 4; })}});
}

TEST_CASE("tangent_faults_are_refused_by_name") {
  using enum SectionKind;
  check_refused(character_pack(), {{"vertex 2: tangent is not a unit vector", set<float>(kTangents, 8, 0.1f)},
                                   {"vertex 2: tangent is not a unit vector", set<float>(kTangents, 9, kNan)},
                                   {"vertex 11: its tangent's w is 0", set<float>(kTangents, 47, 0.0f)},
                                   {"vertex 0: its tangent's w is nan", set<float>(kTangents, 3, kNan)},
                                   {"vertex 1: its tangent's w is 1.5", set<float>(kTangents, 7, 1.5f)}});
  baker::Character character = test::small_character();
  const baker::TissueLayout layout = test::small_layout(character);
  character.tangents.pop_back();
  check_refused(baker::pack_character(character, layout, test::small_modes(layout)),
                {{"tangents: 44 numbers for 12 vertices", [](PackEditor&) {}}});
}

TEST_CASE("a_pack_without_primitives_is_refused") {
  baker::PackWriter writer = baker::PackWriter::from_pack(character_pack());
  writer.section(SectionKind::kPrimitives, std::vector<PrimitiveRecord>());
  check_refused(writer.finish(),
                {{"primitives: have 0 vertices and 0 triangles, the character 12", [](PackEditor&) {}}});
}

// skinning, extrapolate, network, modal.
TEST_CASE("tier_faults_are_refused_by_name") {
  using enum SectionKind;
  const auto tier = [](size_t index, auto apply) { return change<TierRecord>(kTiers, index, apply); };
  check_refused(character_pack(),
                {{"tier 2: 5 is not known", tier(2, [](auto& t) { t.tier = 5; })},
                 {"tier 2: 1 at LOD 0 does not ascend", tier(2, [](auto& t) { t.tier = 1; })},
                 {"tier 3: 3 is not known", tier(3, [](auto& t) { t.tier = 3; })},
                 {"tier 2: cost nan", tier(2, [](auto& t) { t.cost_us = kNan; })},
                 {"tier 2: cost -1", tier(2, [](auto& t) { t.cost_us = -1; })},
                 {"p99 inf", tier(2, [](auto& t) { t.cost_p99_us = kInfinity; })},
                 {"tier 2: an error", tier(2, [](auto& t) { t.error_mm = -1; })},
                 {"tier 2: an error", tier(2, [](auto& t) { t.error_ratio = kInfinity; })},
                 {"tier 2: an error", tier(2, [](auto& t) { t.error_p95_mm = -1; })},
                 {"tier 2: an error", tier(2, [](auto& t) { t.worst_error_ratio = -1; })},
                 {"tier 2: clip 1 of 1", tier(2, [](auto& t) { t.worst_clip = 1; })},
                 {"tier 2: LOD 1", tier(2, [](auto& t) { t.level = 1; })}});
}

TEST_CASE("tissue_faults_are_refused_by_name") {
  using enum SectionKind;
  const auto region = [](auto apply) { return change<RegionRecord>(kRegions, 1, apply); };
  const auto node = [](auto apply) { return change<NodeRecord>(kNodes, 4, apply); };
  check_refused(
      character_pack(),
      {{"region 1: its name", region([](auto& r) { r.name = 100000; })},
       {"region 1: held at node 2 of 2", region([](auto& r) { r.anchor_node = 2; })},
       {"region 1: 4097 nodes", region([](auto& r) { r.node_count = 4097; })},
       {"region 1: 0 nodes", region([](auto& r) { r.node_count = 0; })},
       {"region 1: nodes do not follow", region([](auto& r) { r.first_node = 2; })},
       {"region 1: nodes do not follow", region([](auto& r) { r.node_count = 3; })},
       {"region 1: vertices do not follow", region([](auto& r) { r.first_vertex = 3; })},
       {"region 1: vertices do not follow", region([](auto& r) { r.vertex_count = 5; })},
       {"region 1: vertices padded", region([](auto& r) { r.padded_vertices = 8; })},
       {"region 1: embedding weights do not", region([](auto& r) { r.carry = ~uint64_t{0}; })},
       {"region 1: centre", region([](auto& r) { r.center_m[1] = kNan; })},
       {"region 1: radius", region([](auto& r) { r.radius_m = 0; })},
       {"region 1: displacement limit", region([](auto& r) { r.displacement_limit_m = kInfinity; })},
       {"region 1: touches_body is 2", region([](auto& r) { r.touches_body = 2; })},
       {"that no region owns", region([](auto& r) { r.node_count = 1; })},
       {"region 0: vertex 4 does not ascend", set<uint32_t>(kRegionVertices, 1, 4u)},
       {"region 1: vertex 12", set<uint32_t>(kRegionVertices, 7, 12u)},
       {"region 0: an embedding weight", set<float>(kCarry, 2, kNan)},
       {"region 0: padding", set<float>(kCarry, 4, 1.0f)},
       {"node 4: position", node([](auto& n) { n.position_m[0] = kNan; })},
       {"node 4: normal", node([](auto& n) { n.normal[0] = 5; })},
       {"node 4: stiffness", node([](auto& n) { n.stiffness = 1.1f; })},
       {"node 4: region 2", node([](auto& n) { n.region = 2; })},
       {"node 4: not among", node([](auto& n) { n.region = 0; })},
       {"node 4: skinned to joint 9", node([](auto& n) { n.skin.joint[0] = 9; })},
       {"graph rows: do not cover", set<uint32_t>(kGraphRows, 0, 1u)},
       {"graph rows: do not cover", set<uint32_t>(kGraphRows, 5, 0u)},
       {"graph rows: not ascending", set<uint32_t>(kGraphRows, 2, 0xffffffffu)},
       {"graph row 2: column 3", set<uint32_t>(kGraphColumns, 6, 3u)},
       {"graph row 0: column 0", set<uint32_t>(kGraphColumns, 1, 0u)},
       {"graph values: number 3", set<float>(kGraphValues, 3, kNan)}});
}

TEST_CASE("mode_faults_are_refused_by_name") {
  using enum SectionKind;
  const auto region = [](auto apply) { return change<RegionModesRecord>(kRegionModes, 1, apply); };
  const auto mode = [](auto apply) { return change<ModeRecord>(kModes, 4, apply); };
  check_refused(
      character_pack(),
      {{"region modes 1: 65 modes", region([](auto& r) { r.mode_count = 65; })},
       {"region modes 1: nodes padded to 32", region([](auto& r) { r.padded = 32; })},
       {"region modes 1: first mode at 0", region([](auto& r) { r.first_rad_per_s = 0; })},
       {"region modes 1: first mode at nan", region([](auto& r) { r.first_rad_per_s = kNan; })},
       {"region modes 1: modes do not follow", region([](auto& r) { r.first_mode = 2; })},
       {"region modes 1: modes do not follow", region([](auto& r) { r.mode_count = 3; })},
       {"region modes 1: matrices do not follow", region([](auto& r) { r.matrices += 16; })},
       {"region modes 1: matrices do not follow", region([](auto& r) { r.matrices = ~uint64_t{0}; })},
       {"region modes 1: the rest's recurrence", region([](auto& r) { r.rest_a1 = 2.5f; })},
       {"region modes 1: the first mode's recurrence", region([](auto& r) { r.first_a1 = 2.5f; })},
       {"region modes 1: the rest's recurrence", region([](auto& r) { r.rest_a2 = kNan; })},
       {"region modes 1: rest_gain", region([](auto& r) { r.rest_gain = kInfinity; })},
       {"region modes 1: reserved", region([](auto& r) { r.reserved[4] = 1; })},
       {"that no region owns",  // all zero, so that rows of other lengths have good padding
        [](PackEditor& editor) {
          std::ranges::fill(editor.section<float>(kModeMatrices), 0.0f);
          editor.section<RegionModesRecord>(kRegionModes)[1].mode_count = 1;
        }},
       {"region modes 0: a number of a matrix", set<float>(kModeMatrices, 2 * 3 * 16 + 2, kNan)},
       {"region modes 0: a number of a matrix",
        set<float>(kModeMatrices, (2 * 3 + 9 * 3 - 1) * 16 + 2, kNan)},
       {"region modes 0: padding", set<float>(kModeMatrices, 15, 1.0f)},
       {"region modes 0: padding", set<float>(kModeMatrices, 2 * 3 * 16 + 15, 1.0f)},
       {"region modes 0: padding", set<float>(kModeMatrices, (2 * 3 + 1) * 16 + 15, 1.0f)},
       {"region modes 0: padding", set<float>(kModeMatrices, (2 * 3 + 9 * 3 - 1) * 16 + 15, 1.0f)},
       {"mode 4: 0 rad/s", mode([](auto& m) { m.rad_per_s = 0; })},
       {"mode 4: damping ratio -1", mode([](auto& m) { m.damping_ratio = -1; })},
       {"mode 4: its recurrence", mode([](auto& m) { m.a2 = -1; })},
       {"mode 4: its recurrence", mode([](auto& m) { m.a1 = 1 - m.a2; })},
       {"mode 4: its recurrence", mode([](auto& m) { m.a1 = m.a2 - 1; })},
       {"mode 4: its recurrence", mode([](auto& m) { m.a1 = kNan; })},
       {"mode 4: gain", mode([](auto& m) { m.gain = kInfinity; })},
       {"mode 4: reserved", mode([](auto& m) { m.reserved[2] = 1; })}});
}

// Each number here is a number that another pack may have.
TEST_CASE("numbers_that_do_not_go_together_are_refused_by_name") {
  using enum SectionKind;
  const auto region = [](auto apply) { return change<RegionRecord>(kRegions, 1, apply); };
  const auto modes = [](auto apply) { return change<RegionModesRecord>(kRegionModes, 1, apply); };
  const auto mode = [](auto apply) { return change<ModeRecord>(kModes, 4, apply); };
  const auto joint = [](auto apply) { return change<JointRecord>(kJoints, 1, apply); };
  check_refused(character_pack(),
                {{"node 4: beyond the radius of its region 1",
                  change<NodeRecord>(kNodes, 4, [](auto& n) { n.position_m[0] += 50; })},
                 {"beyond the radius of its region 1", region([](auto& r) { r.center_m[2] = 1000; })},
                 {"mode 4: gain", mode([](auto& m) { m.gain *= 3; })},
                 {"mode 4: gain", mode([](auto& m) { m.rad_per_s *= 3; })},
                 {"region modes 1: rest_gain", modes([](auto& r) { r.rest_gain *= -1; })},
                 {"region modes 0: its matrices amplify their input more than 1e6",
                  [](PackEditor& editor) {
                    editor.section<float>(kModeMatrices)[0] =
                        1e6f;  // a shape, and what a displacement holds of it
                    editor.section<float>(kModeMatrices)[(2 * 3 + 9 * 2) * 16] = 1e3f;
                  }},
                 {"region modes 0: its matrices amplify their input more than 1e6",
                  set<float>(kModeMatrices, 2 * 3 * 16, 1e8f)},
                 {"joint 1: its bind matrix goes beyond 1e5", joint([](auto& j) {
                    for (const size_t at : {size_t{0}, size_t{5}, size_t{10}}) j.inverse_bind[at] *= 1e-4f;
                    j.inverse_bind[3] = 100;
                  })}});
}

TEST_CASE("numbers_of_no_character_are_refused_by_name") {
  using enum SectionKind;
  const auto region = [](auto apply) { return change<RegionRecord>(kRegions, 1, apply); };
  check_refused(
      character_pack(),
      {{"height is 200000 m", change<CharacterRecord>(kCharacter, 0, [](auto& c) { c.height_m = 2e5f; })},
       {"unit of the character's file is 1e-30 m",
        change<CharacterRecord>(kCharacter, 0, [](auto& c) { c.unit_m = 1e-30f; })},
       {"positions: number 4 is -200000, not within +-100000", set<float>(kPositions, 4, -2e5f)},
       {"clip frames: number 30 is 2e+06", set<float>(kClipFrames, 30, 2e6f)},
       {"clip 0: rate 1e-20 Hz", change<ClipRecord>(kClips, 0, [](auto& c) { c.rate_hz = 1e-20f; })},
       {"network: rate 1e+20 Hz", change<NetworkRecord>(kNetwork, 0, [](auto& n) { n.rate_hz = 1e20f; })},
       {"network: output scale",
        change<NetworkRecord>(kNetwork, 0, [](auto& n) { n.output_scale = -1e30f; })},
       {"network: length unit", change<NetworkRecord>(kNetwork, 0, [](auto& n) { n.length_unit = 1e-30f; })},
       {"input 0: scale", change<InputRecord>(kInputs, 0, [](auto& i) { i.scale = 1e30f; })},
       {"region 1: radius 1e-20 m", region([](auto& r) { r.radius_m = 1e-20f; })},
       {"region 1: displacement limit 1e+20 m", region([](auto& r) { r.displacement_limit_m = 1e20f; })},
       {"an embedding weight is not within +-100", set<float>(kCarry, 0, 1e20f)},
       {"graph values: number 3 is 4", set<float>(kGraphValues, 3, 4.0f)},
       {"mode 4: 1e-30 rad/s", change<ModeRecord>(kModes, 4, [](auto& m) { m.rad_per_s = 1e-30f; })},
       {"tier 0: cost", change<TierRecord>(kTiers, 0, [](auto& t) { t.cost_us = 1e20f; })},
       {"tier 0: an error", change<TierRecord>(kTiers, 0, [](auto& t) { t.error_ratio = 1e20f; })}});
}

TEST_CASE("a_character_without_a_network_is_taken_and_must_be_without_all_of_it") {
  const std::vector<std::byte> bytes = test::small_weightless_pack();
  PackView view;
  PackEditor good(bytes);
  const Status taken = good.open(&view);
  INFO(taken.message);
  REQUIRE(taken.ok());
  CHECK_FALSE(has_network(view));
  CHECK(view.network->rate_hz == 60);
  CHECK(view.tiers.size() == 3);

  using enum SectionKind;
  const auto network = [](auto apply) { return change<NetworkRecord>(kNetwork, 0, apply); };
  check_refused(bytes, {{"network that is not there", network([](auto& n) { n.layer_count = 1; })},
                        {"network that is not there", network([](auto& n) { n.length_unit = 1; })},
                        {"network that is not there", network([](auto& n) { n.moving = 1; })},
                        {"rate", network([](auto& n) { n.rate_hz = 0; })},
                        {"reserved", network([](auto& n) { n.reserved[0] = 1; })},
                        {"tier 2: a network", change<TierRecord>(kTiers, 2, [](auto& t) { t.tier = 2; })}});
  check_refused(character_pack(), {{"not there", network([](auto& n) { n.model = ModelKind::kNone; })}});
}

TEST_CASE("a_character_whose_network_has_no_inputs_is_unsupported") {
  baker::PackWriter writer(FileKind::kCharacter);
  baker::add_network(test::small_paper_weights(), writer);
  const Status status = PackEditor(writer.finish()).open();
  CHECK(status.code == StatusCode::kUnsupported);
  CHECK_THAT(status.message, Contains("bake with weights whose metadata names 'inputs'"));
}

TEST_CASE("the_allocation_count_sees_an_allocation") {
  const size_t before = test::allocation_count();
  delete test::keep(new int(3));
  CHECK(test::allocation_count() == before + 1);
}

TEST_CASE("a_good_pack_is_taken_without_an_allocation") {
  PackEditor character(character_pack()), model(test::small_model());
  PackView view, model_view;
  const size_t before = test::allocation_count();
  const Status status = character.open(&view);
  const Status model_status = model.open(&model_view);
  CHECK(test::allocation_count() == before);
  INFO(status.message << model_status.message);
  REQUIRE(status.ok());
  REQUIRE(model_status.ok());
  CHECK(view.kind == FileKind::kCharacter);
  CHECK(view.character->node_count == 5);
  CHECK(std::string(string_at(view, view.regions[1].name)) == "tip");
  CHECK(std::string(string_at(view, kNoIndex)).empty());
  CHECK(model_view.inputs.empty());
  CHECK(model_view.network->input_width == 9);
}

TEST_CASE("a_refused_pack_is_not_allocated_for_either") {
  PackEditor editor(character_pack());
  editor.section<float>(SectionKind::kWeights)[0] = kNan;
  editor.seal();
  const size_t before = test::allocation_count();
  const Status status = editor.open();
  CHECK(test::allocation_count() == before);
  CHECK_FALSE(status.ok());
}

TEST_CASE("rods_that_disagree_with_the_skeleton_are_refused_by_name") {
  using enum SectionKind;
  const std::vector<std::byte> good = test::small_rod_pack();
  const auto segment = [](size_t index, auto apply) {
    return change<RodSegmentRecord>(kRodSegments, index, [=](RodSegmentRecord& s) { apply(s); });
  };
  const auto rod = [](auto apply) { return change<RodRecord>(kRods, 0, [=](RodRecord& r) { apply(r); }); };
  const std::vector<Damage> damages = {
      {"rods: 1 there", change<CharacterRecord>(kCharacter, 0, [](CharacterRecord& c) { c.rod_count = 2; })},
      {"rods: 1 there", change<CharacterRecord>(kCharacter, 0, [](CharacterRecord& c) { c.rod_count = 0; })},
      {"its name lies outside", rod([](RodRecord& r) { r.name = 1u << 30; })},
      {"hangs on joint 3 of 3", rod([](RodRecord& r) { r.attach = 3; })},
      {"0 segments", rod([](RodRecord& r) { r.segment_count = 0; })},
      {"do not follow", rod([](RodRecord& r) { r.segment_count = 4; })},
      {"do not follow", rod([](RodRecord& r) { r.first_segment = 1; })},
      {"segments that no rod owns", rod([](RodRecord& r) { r.segment_count = 2; })},
      {"gravity", rod([](RodRecord& r) { r.gravity = -1; })},
      {"gravity", rod([](RodRecord& r) { r.gravity = kNan; })},
      {"gravity", rod([](RodRecord& r) { r.gravity = 101; })},
      {"rotation limit", rod([](RodRecord& r) { r.turn_limit_rad = -0.1f; })},
      {"rotation limit", rod([](RodRecord& r) { r.turn_limit_rad = kNan; })},
      {"rotation limit", rod([](RodRecord& r) { r.turn_limit_rad = 4; })},
      {"sag", rod([](RodRecord& r) { r.sag = 1.5f; })},
      {"its end is held by joint 3 of 3", rod([](RodRecord& r) { r.end_holder = 4; })},
      {"held by a bone that a rod moves", rod([](RodRecord& r) { r.end_holder = 3; })},
      {"a branch of a rod whose end is held",
       [=](PackEditor& editor) {
         rod([](RodRecord& r) { r.end_holder = 1; })(editor);
         segment(2, [](RodSegmentRecord& s) { s.parent = 0; })(editor);
       }},
      {"frequency", rod([](RodRecord& r) { r.frequency_hz = -1; })},
      {"parent", segment(0, [](RodSegmentRecord& s) { s.parent = 0; })},
      {"parent", segment(1, [](RodSegmentRecord& s) { s.parent = 1; })},  // a cycle
      {"parent", segment(1, [](RodSegmentRecord& s) { s.parent = kNoIndex; })},
      {"ends are not within", segment(0, [](RodSegmentRecord& s) { s.end_m[1] = kInfinity; })},
      {"length 0", segment(2, [](RodSegmentRecord& s) { s.end_m[1] = s.begin_m[1]; })},
      {"begin where its parent ends", segment(1, [](RodSegmentRecord& s) { s.begin_m[1] += 0.001f; })},
      {"radius 0", segment(0, [](RodSegmentRecord& s) { s.radius_m = 0; })},
      {"density", segment(0, [](RodSegmentRecord& s) { s.density_kg_m3 = -1; })},
      {"Young's modulus", segment(2, [](RodSegmentRecord& s) { s.young_modulus_pa = 0; })},
      {"torsion modulus", segment(2, [](RodSegmentRecord& s) { s.torsion_modulus_pa = kNan; })},
      {"damping", segment(2, [](RodSegmentRecord& s) { s.damping_s = -1; })},
      {"drag", segment(2, [](RodSegmentRecord& s) { s.drag_per_s = kInfinity; })},
      {"reserved", segment(2, [](RodSegmentRecord& s) { s.reserved[0] = 1; })},
      {"joint 3 of 3", segment(2, [](RodSegmentRecord& s) { s.joint = 3; })},
      {"another bone than its joint", segment(2, [](RodSegmentRecord& s) { s.joint = 1; })},
      {"another bone than its joint", segment(0, [](RodSegmentRecord& s) { s.joint = 0; })},
      {"hangs on no bone", segment(0, [](RodSegmentRecord& s) { s.joint = kNoIndex; })},
      {"hangs on no bone", segment(2, [](RodSegmentRecord& s) { s.joint = kNoIndex; })},
      {"another segment", set<uint32_t>(kJointRods, 2, 0)},
      {"rods: 0.5 ticks a second, below 1",
       change<NetworkRecord>(kNetwork, 0, [](NetworkRecord& n) { n.rate_hz = 0.5f; })},
      {"neither the joint's own", set<uint32_t>(kJointRods, 0, 2)},
      {"neither the joint's own", set<uint32_t>(kJointRods, 0, 77)},
  };
  PackEditor untouched(good);
  REQUIRE(untouched.open().ok());
  check_refused(good, damages);
}

TEST_CASE("a_learned_start_without_a_network_that_can_make_it_is_refused_by_name") {
  using enum SectionKind;
  const std::vector<std::byte> good = test::small_learned_pack();
  const auto record = [](auto apply) {
    return change<NetworkRecord>(kRodNetwork, 0, [=](NetworkRecord& n) { apply(n); });
  };
  const auto rod = [](auto apply) { return change<RodRecord>(kRods, 0, [=](RodRecord& r) { apply(r); }); };
  PackEditor untouched(good);
  REQUIRE(untouched.open().ok());
  check_refused(
      good,
      {{"start 2 is not known", rod([](RodRecord& r) { r.start = 2; })},
       {"reserved", rod([](RodRecord& r) { r.reserved = 1; })},
       {"latent width 12", record([](NetworkRecord& n) { n.max_channels = 12; }), StatusCode::kUnsupported},
       {"latent width 128", record([](NetworkRecord& n) { n.max_channels = 128; }), StatusCode::kUnsupported},
       {"dense layers stated", record([](NetworkRecord& n) { n.layer_count = 3; })},
       {"17 blocks", record([](NetworkRecord& n) { n.blocks = 17; })},
       {"inputs and", change<DenseRecord>(kRodDense, 2, [](DenseRecord& d) { d.inputs = 9; })},
       {"weights are not where", change<DenseRecord>(kRodDense, 1, [](DenseRecord& d) { d.w += 16; })},
       {"not finite", set<float>(kRodWeights, 5, kNan)},
       {"a norm above 1000", [](PackEditor& editor) {
          const auto weights = editor.section<float>(kRodWeights);
          weights[weights.size() - 32] = 1001;
        }}});
  check_refused(test::small_rod_pack(),
                {{"a learned start, and no network for it", rod([](RodRecord& r) { r.start = 1; })}});
}

TEST_CASE("rods_network_of_another_model_is_refused_as_not_supported") {
  PackEditor editor(test::small_learned_pack());
  editor.section<NetworkRecord>(SectionKind::kRodNetwork)[0].model = ModelKind::kDeepEmulator;
  editor.seal();
  const Status status = editor.open();
  CHECK(status.code == StatusCode::kUnsupported);
  CHECK(std::string(status.message).find("weights of coping_net") != std::string::npos);
}

TEST_CASE("capsules_about_bones_that_are_none_are_refused_by_name") {
  using enum SectionKind;
  const std::vector<std::byte> good = test::small_rod_pack();
  const auto proxy = [](auto apply) {
    return change<ProxyRecord>(kProxies, 0, [=](ProxyRecord& r) { apply(r); });
  };
  check_refused(good,
                {{"body colliders: 1 there",
                  change<CharacterRecord>(kCharacter, 0, [](CharacterRecord& c) { c.proxy_count = 2; })},
                 {"body colliders: 1 there",
                  change<CharacterRecord>(kCharacter, 0, [](CharacterRecord& c) { c.proxy_count = 0; })},
                 {"more than 64",
                  change<CharacterRecord>(kCharacter, 0, [](CharacterRecord& c) { c.proxy_count = 65; })},
                 {"moves with joint 3 of 3", proxy([](ProxyRecord& r) { r.joint = 3; })},
                 {"ends are not within", proxy([](ProxyRecord& r) { r.to_m[1] = kNan; })},
                 {"radius 0", proxy([](ProxyRecord& r) { r.radius_m = 0; })},
                 {"radius", proxy([](ProxyRecord& r) { r.radius_m = kNan; })}});
}

TEST_CASE("a_pack_without_rods_has_none") {
  PackEditor editor(character_pack());
  PackView view;
  REQUIRE(editor.open(&view).ok());
  CHECK(view.rods.empty());
  CHECK(view.rod_segments.empty());
  CHECK(view.joint_rods.empty());
}

TEST_CASE("patches_without_all_that_predicts_them_are_refused_by_name") {
  using enum SectionKind;
  const std::vector<std::byte> good = test::small_patch_pack();
  const auto record = [](auto apply) {
    return change<NetworkRecord>(kPatchNetwork, 0, [=](NetworkRecord& n) { apply(n); });
  };
  const auto region = [](size_t r, float cell_m) {
    return change<RegionRecord>(kRegions, r, [=](RegionRecord& record) { record.cell_m = cell_m; });
  };
  PackEditor untouched(good);
  REQUIRE(untouched.open().ok());
  check_refused(
      good, {{"for regions that are not there", region(0, 0)},
             {"cells of -1 m", region(0, -1)},
             {"cells of", region(0, kNan)},
             {"none of its nodes is held", region(1, 0.1f)},
             {"none of its nodes is held", set<uint8_t>(kPatchHeld, 0, 0)},
             {"neither 0 nor 1", set<uint8_t>(kPatchHeld, 1, 2)},
             {"none of its nodes is free",
              [](PackEditor& editor) { std::ranges::fill(editor.section<uint8_t>(kPatchHeld), uint8_t{1}); }},
             {"number 4 is nan", set<float>(kPatchMaterial, 4, kNan)},
             {"24 ticks a second", record([](NetworkRecord& n) { n.rate_hz = 24; })},
             {"moving 0", record([](NetworkRecord& n) { n.moving = 0; }), StatusCode::kUnsupported},
             {"model 3", record([](NetworkRecord& n) { n.model = ModelKind::kCopingNet; }),
              StatusCode::kUnsupported},
             {"widest layer", record([](NetworkRecord& n) { n.max_channels = 40; })},
             {"not finite", set<float>(kPatchWeights, 5, kNan)}});
  check_refused(test::small_character_pack(), {{"no network for regions that want one", region(0, 0.1f)}});
  check_refused(test::small_levels_pack(), {{"cells in a coarser control graph", region(2, 0.1f)}});
}

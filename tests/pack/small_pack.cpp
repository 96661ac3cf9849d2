// small_pack.cpp  The smallest packs that have everything.
#include "tests/pack/small_pack.hpp"

#include <random>

#include "baker/mesh/graph/leave_out.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "baker/pack/network/dense_pack.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "tests/pack/random_coping_net.hpp"

namespace sinew::test {
namespace {

using baker::Vector3;

// Layers of 5 and 3 channels that read `inputs` numbers a node.
baker::Safetensors make_weights(size_t inputs, bool self_weights) {
  std::mt19937 random(3);
  baker::Safetensors weights;
  weights.path = "small.safetensors";
  const auto add = [&](const std::string& name, std::vector<size_t> shape) {
    std::vector<float> values(shape.size() == 1 ? shape[0] : shape[0] * shape[1]);
    for (float& value : values) value = static_cast<float>(random() % 2001) / 1000 - 1;
    weights.tensors[name] = baker::tensor_f32(std::move(shape), values);
  };
  const size_t channels[] = {5, 3};
  for (size_t l = 0; l < 2; ++l) {
    const std::string prefix = "layers." + std::to_string(l) + ".";
    const size_t f = channels[l], f_in = l == 0 ? inputs : channels[0];
    add(prefix + "W_x", {f_in, 4 * f});
    if (self_weights) add(prefix + "W_s", {f_in, 4 * f});
    add(prefix + "W_h", {f, 4 * f});
    add(prefix + "W_y", {f, 3 * f});
    add(prefix + "b", {4 * f});
  }
  weights.metadata = {
      {"sinew.model", "alt_conv_lstm"}, {"sinew.version", "1"}, {"channels", "5,3"}, {"rate_hz", "60"}};
  return weights;
}

// Random layers of a network of chains.
struct ChainWeights {
  explicit ChainWeights(const char* path) { weights.path = path; }
  void add_tensor(const std::string& name, std::vector<size_t> shape) {
    std::vector<float> values(shape.size() == 1 ? shape[0] : shape[0] * shape[1]);
    for (float& value : values) value = static_cast<float>(random() % 2001) / 1000 - 1;
    weights.tensors[name] = baker::tensor_f32(std::move(shape), values);
  }
  void add(const std::string& name, const std::vector<size_t>& widths) {
    for (size_t k = 0; k + 1 < widths.size(); ++k) {
      add_tensor(name + std::to_string(k) + ".weight", {widths[k + 1], widths[k]});
      add_tensor(name + std::to_string(k) + ".bias", {widths[k + 1]});
    }
  }
  std::mt19937 random{5};
  baker::Safetensors weights;
};

Eigen::Matrix4d translation(const Vector3& offset) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topRightCorner<3, 1>() = offset;
  return m;
}

void add_joint(const std::string& name, int parent, const Vector3& offset, baker::Character* character) {
  baker::Node node;
  node.name = name;
  node.parent = parent;
  node.translation = offset;
  const Vector3 before =
      parent < 0 ? Vector3(0, 0, 0) : Vector3(-character->inverse_bind.back().topRightCorner<3, 1>());
  character->joint_node.push_back(static_cast<int>(character->nodes.size()));
  character->joint_parent.push_back(parent);
  character->nodes.push_back(node);
  character->inverse_bind.push_back(translation(-(before + offset)));
}

// Vertex v of the bar: four a ring, three rings along Y.
void add_vertex(int v, baker::Character* character) {
  const double angle = 1.5707963267948966 * (v % 4);
  const Vector3 around(std::cos(angle), 0, std::sin(angle));
  baker::Influences skin;
  skin.joint = {v / 4, v / 4 == 0 ? 1 : 0};
  skin.weight = {0.75, 0.25};
  character->positions.push_back(0.1 * around + Vector3(0, 0.25 * (v / 4), 0));
  character->normals.push_back(around);
  character->skin.push_back(skin);
  character->colors.push_back({200, 150, 100, 255});
  character->stiffness.push_back(0.1 * (v % 4));
  character->welded.push_back(v);
  character->tangents.push_back({Vector3::UnitY(), v % 2 == 0 ? 1.0 : -1.0});
}

baker::Clip swing() {
  baker::Channel channel;
  channel.node = 1;
  channel.path = baker::Path::kRotation;
  channel.times_s = {0, 0.1};
  channel.values = {0, 0, 0, 1, 0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  return {"swing", 0.1, {channel}};
}

baker::ControlNode make_node(const baker::Character& character, int vertex, int region) {
  const auto v = static_cast<size_t>(vertex);
  return {vertex,           region, character.positions[v], character.normals[v], character.stiffness[v],
          character.skin[v]};
}

baker::Region make_region(const std::string& name, int first_node, std::vector<baker::ControlNode> nodes,
                          std::vector<int> vertices) {
  baker::Region region;
  region.name = name;
  region.first_node = first_node;
  region.node_count = static_cast<int>(nodes.size());
  region.vertices = std::move(vertices);
  for (const baker::ControlNode& node : nodes)
    region.center += node.position / static_cast<double>(nodes.size());
  for (const baker::ControlNode& node : nodes) {
    region.radius_m = std::max(region.radius_m, (node.position - region.center).norm());
    region.carry.emplace_back(region.vertices.size(), 1.0 / static_cast<double>(nodes.size()));
  }
  return region;
}

}  // namespace

baker::Safetensors small_weights() {
  baker::Safetensors weights = make_weights(32, true);
  const char* const inputs =
      "rest_position,rest_normal,stiffness,angular_acceleration,angular_velocity,gravity_change,displacement,"
      "velocity,felt_step,base_step,turn,frequency";
  weights.metadata.insert({{"inputs", inputs},
                           {"frame", "bent"},
                           {"base", "modal_2"},
                           {"input_scales", "1,1,1,0.01,0.1,0.1,1,10,1,10,1,1"},
                           {"envelope", "2,2,2,8,8,8,8,8,8,8,8,8"},
                           {"length_unit", "0.01"},
                           {"output_scale", "0.5"},
                           {"output_leak", "0.1"},
                           {"hidden_leak", "0.2"},
                           {"state_clamp", "8"},
                           {"error_mm", "0.5"},
                           {"error_ratio", "0.25"},
                           {"made_by", "a key that nobody knows"}});
  return weights;
}

baker::Safetensors small_paper_weights() { return make_weights(9, false); }

baker::Safetensors small_deep_emulator() {
  ChainWeights chains("deep_emulator.safetensors");
  chains.add("alpha.", {18, 64, 64, 64, 64, 64});
  chains.add("beta.", {37, 128, 128, 128, 128, 128});
  chains.add("gamma.", {192, 192, 192, 192, 192, 3});
  chains.weights.metadata = {{"sinew.model", "deep_emulator"}, {"sinew.version", "1"}, {"rate_hz", "24"}};
  return chains.weights;
}

baker::Safetensors small_coping_net() {
  ChainWeights chains("coping_net.safetensors");
  chains.add("encoder.node.", {14, 5, 5});
  chains.add("encoder.edge.", {5, 5, 5});
  for (const char* block : {"blocks.0.", "blocks.1."}) {
    chains.add(std::string(block) + "node.", {10, 5, 5});
    chains.add(std::string(block) + "edge.", {15, 5, 5});
  }
  chains.add("decoder.node.", {5, 5, 6});
  chains.add("decoder.edge.", {5, 5, 6});
  for (const char* norm : {"norm.node", "norm.edge"})
    chains.weights.tensors[norm] = baker::tensor_f32({6}, {0, 1, 2, 3, 4, 5});
  chains.weights.metadata = {{"sinew.model", "coping_net"},
                             {"sinew.version", "1"},
                             {"latent", "5"},
                             {"blocks", "2"},
                             {"depth", "1"}};
  return chains.weights;
}

baker::Character small_character() {
  baker::Character character;
  character.name = "bar";
  character.unit_m = 0.01;
  add_joint("root", -1, {0, 0, 0}, &character);
  add_joint("middle", 0, {0, 0.25, 0}, &character);
  add_joint("tip", 1, {0, 0.25, 0}, &character);
  for (int v = 0; v < 12; ++v) add_vertex(v, &character);
  for (int v = 0; v < 8; ++v) {
    const int next = v / 4 * 4 + (v + 1) % 4;
    character.triangles.push_back({v, v + 4, next});
    character.triangles.push_back({next, v + 4, next + 4});
  }
  character.primitives = {
      {.material = "skin", .vertex_count = 12, .triangle_count = 8},
      {.vertex_count = 12, .first_triangle = 8, .triangle_count = 8, .index = 2, .sharer = 0}};
  character.clips.push_back(swing());
  return character;
}

baker::TissueLayout small_layout(const baker::Character& character) {
  baker::TissueLayout layout;
  layout.stiffness = character.stiffness;
  for (int vertex : {4, 5, 6}) layout.nodes.push_back(make_node(character, vertex, 0));
  for (int vertex : {8, 10}) layout.nodes.push_back(make_node(character, vertex, 1));
  layout.regions.push_back(
      make_region("belly", 0, {layout.nodes.begin(), layout.nodes.begin() + 3}, {4, 5, 6, 7}));
  layout.regions.push_back(
      make_region("tip", 3, {layout.nodes.begin() + 3, layout.nodes.end()}, {8, 9, 10, 11}));
  layout.edges = {{0, 1}, {1, 2}, {3, 4}};
  return layout;
}

std::vector<baker::ModalBasis> small_modes(const baker::TissueLayout& layout) {
  std::mt19937 random(4);
  const auto numbers = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd out(rows, columns);
    for (double& value : out.reshaped()) value = static_cast<double>(random() % 2001) / 1000 - 1;
    return out;
  };
  std::vector<baker::ModalBasis> modes;
  for (const baker::Region& region : layout.regions) {
    const Eigen::Index rows = 3 * region.node_count, count = modes.empty() ? 3 : 2;
    modes.push_back({Eigen::VectorXd::LinSpaced(count, 20, 60), Eigen::VectorXd::Constant(count, 0.1),
                     numbers(rows, count), numbers(rows, count), numbers(count, rows),
                     1e-3 * numbers(rows, rows), 80, 0.2, modes.empty() ? 1 : 0, 20, 0.1});
  }
  return modes;
}

std::vector<std::byte> small_model() {
  baker::PackWriter writer(pack::FileKind::kModel);
  baker::add_network(small_paper_weights(), writer);
  return writer.finish();
}

std::vector<baker::HeardRanges> small_paper_ranges() {
  const std::vector<float> inputs(9, 1.0f), channels(5, 1.0f);
  return {{inputs, inputs, channels, channels}};
}

std::vector<std::byte> small_chain_model() {
  baker::PackWriter writer(pack::FileKind::kModel);
  baker::add_chains(small_coping_net(), writer);
  return writer.finish();
}

std::vector<std::byte> small_weightless_pack() {
  const baker::Character character = small_character();
  const baker::TissueLayout layout = small_layout(character);
  return baker::pack_character(character, layout, small_modes(layout));
}

baker::GraphLevel small_coarser_level(const baker::TissueLayout& layout) {
  baker::TissueLayout coarse;
  coarse.stiffness = layout.stiffness;
  coarse.nodes = {layout.nodes[0], layout.nodes[1], layout.nodes[3]};
  coarse.regions = {make_region("belly", 0, {layout.nodes[0], layout.nodes[1]}, layout.regions[0].vertices),
                    make_region("tip", 2, {layout.nodes[3]}, layout.regions[1].vertices)};
  for (size_t r = 0; r < 2; ++r) coarse.regions[r].radius_m = layout.regions[r].radius_m;
  coarse.edges = {{0, 1}};
  return {coarse, small_modes(coarse)};
}

std::vector<std::byte> small_levels_pack() {
  const baker::Character character = small_character();
  const baker::TissueLayout layout = small_layout(character);
  const std::vector<baker::GraphLevel> coarser = {small_coarser_level(layout)};
  return baker::pack_character(character, layout, small_modes(layout), nullptr, coarser);
}

std::vector<std::byte> small_left_out_pack() {
  const baker::Character character = small_character();
  const baker::TissueLayout layout = small_layout(character);
  const baker::GraphLevel coarser = small_coarser_level(layout);
  const baker::TissueLayout less = baker::leave_out(coarser.layout, {"tip"}, "small pack");
  const std::vector<baker::GraphLevel> levels = {coarser, {less, small_modes(less)}};
  return baker::pack_character(character, layout, small_modes(layout), nullptr, levels);
}

std::vector<baker::Rod> small_rods() {
  baker::Rod rod;
  rod.name = "top";
  rod.gravity = 2;
  rod.sag = 0.25;
  const auto bone = [](int joint, int parent, double from, double to) {
    return baker::RodBone{joint, parent, {0, from, 0}, {0, to, 0}, 0.1, 900, 1e5, 2e5, 0.02, 0.5};
  };
  rod.bones = {bone(1, -1, 0.25, 0.4), bone(-1, 0, 0.4, 0.5), bone(2, 1, 0.5, 0.75)};
  return {rod};
}

std::vector<std::byte> small_rod_pack() {
  const baker::Character character = small_character();
  baker::TissueLayout layout = small_layout(character);
  layout.rods = small_rods();
  layout.proxies = {{0, {0, 0.1, 0}, {0, 0.2, 0}, 0.05}};
  return baker::pack_character(character, layout, small_modes(layout));
}

std::vector<std::byte> small_learned_pack() {
  const baker::Character character = small_character();
  baker::TissueLayout layout = small_layout(character);
  layout.rods = small_rods();
  layout.rods[0].learned_start = true;
  const baker::Safetensors weights = random_coping_net();
  return baker::pack_character(character, layout, small_modes(layout), nullptr, {}, &weights);
}

baker::Safetensors small_emulator() {
  ChainWeights chains("emulator.safetensors");
  chains.add("alpha.", {18, 16, 16, 16, 16, 16});
  chains.add("beta.", {37, 32, 32, 32, 32, 32});
  chains.add("gamma.", {48, 48, 48, 48, 48, 3});
  chains.weights.metadata = {{"sinew.model", "deep_emulator"},
                             {"sinew.version", "1"},
                             {"rate_hz", "60"},
                             {"latent", "16"},
                             {"frame", "going_on"}};
  return chains.weights;
}

baker::TissueLayout small_patch_layout(const baker::Character& character) {
  baker::TissueLayout layout = small_layout(character);
  layout.regions[0].emulated = true;
  layout.regions[0].cell_m = 0.1;
  for (size_t n = 0; n < 3; ++n)
    layout.nodes[n].corner = {.is_corner = true, .is_held = n == 0, .stiffness_per_s2 = 7200, .mass = 0.5};
  return layout;
}

std::vector<std::byte> small_patch_pack() {
  const baker::Character character = small_character();
  const baker::TissueLayout layout = small_patch_layout(character);
  const baker::Safetensors weights = small_emulator();
  return baker::pack_character(character, layout, small_modes(layout), nullptr, {}, nullptr, &weights);
}

std::vector<std::byte> small_character_pack() {
  const baker::Character character = small_character();
  const baker::TissueLayout layout = small_layout(character);
  const baker::Safetensors weights = small_weights();
  return baker::pack_character(character, layout, small_modes(layout), &weights);
}

}  // namespace sinew::test

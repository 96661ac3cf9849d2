// describe.cpp  What is inside a file, as JSON.
#include "baker/programs/describe/describe.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "baker/pack/character/tier_pack.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "character/contacts/own_body_touches.hpp"
#include "sinew/types.hpp"

namespace sinew::baker {
namespace {

using Json = nlohmann::ordered_json;

Json describe_chains(const pack::PackView& view) {
  const pack::NetworkRecord& record = *view.network;
  size_t parameters = 0;
  for (const pack::DenseRecord& layer : view.dense) parameters += size_t{layer.outputs} * (layer.inputs + 1);
  Json network = {{"model", pack::kModelNames[static_cast<uint32_t>(record.model)]},
                  {"precision", pack::kPrecisionNames[static_cast<uint32_t>(record.precision)]},
                  {"parameters", parameters},
                  {"inputs", Json::array()}};
  if (record.model == pack::ModelKind::kCopingNet)
    network.update({{"latent", record.max_channels}, {"blocks", record.blocks}, {"depth", record.depth}});
  else
    network["rate_hz"] = record.rate_hz;
  return network;
}

Json describe_network(const pack::PackView& view) {
  if (!has_network(view))
    return {{"model", "none"}, {"rate_hz", view.network->rate_hz}, {"inputs", Json::array()}};
  if (!view.dense.empty()) return describe_chains(view);
  const pack::NetworkRecord& record = *view.network;
  Json channels = Json::array(), inputs = Json::array();
  size_t parameters = 0;
  for (const pack::LayerRecord& layer : view.layers) {
    channels.push_back(layer.channels);
    parameters += size_t{layer.channels} * (4 * layer.inputs * (1 + layer.has_self) + 7 * layer.channels + 4);
  }
  for (const pack::InputRecord& input : view.inputs)
    inputs.push_back(
        {{"name", input_name(input.kind)}, {"scale", input.scale}, {"envelope", input.envelope}});
  return {{"model", "alt_conv_lstm"},
          {"precision", pack::kPrecisionNames[static_cast<uint32_t>(record.precision)]},
          {"rate_hz", record.rate_hz},
          {"input_width", record.input_width},
          {"channels", channels},
          {"self_weights", view.layers.front().has_self != 0},
          {"parameters", parameters},
          {"output_scale", record.output_scale},
          {"output_leak", record.output_leak},
          {"hidden_leak", record.hidden_leak},
          {"state_clamp", record.state_clamp},
          {"length_unit", record.length_unit},
          {"inputs", inputs}};
}

Json describe_character(const pack::PackView& view) {
  const pack::CharacterRecord& record = *view.character;
  return {{"name", string_at(view, record.name)},
          {"height_m", record.height_m},
          {"unit_m", record.unit_m},
          {"vertices", record.vertex_count},
          {"triangles", record.triangle_count},
          {"tangents", !view.tangents.empty()},
          {"joints", record.joint_count},
          {"nodes", record.node_count},
          {"graph_entries", view.graph_columns.size()},
          {"multiply_adds_a_tick", multiply_adds(view.layers, view.nodes.size(), view.graph_columns.size())}};
}

Json describe_meshes(const pack::PackView& view) {
  Json meshes = Json::array();
  for (const pack::MeshRecord& mesh : view.meshes)
    meshes.push_back({{"name", string_at(view, mesh.name)},
                      {"first_vertex", mesh.first_vertex},
                      {"vertices", mesh.vertex_count}});
  return meshes;
}

Json describe_primitives(const pack::PackView& view) {
  Json primitives = Json::array();
  for (const pack::PrimitiveRecord& primitive : view.primitives)
    primitives.push_back(
        {{"mesh", string_at(view, view.meshes[primitive.mesh].name)},
         {"index", primitive.index},
         {"material",
          primitive.material == pack::kNoIndex ? Json() : Json(string_at(view, primitive.material))},
         {"first_vertex", primitive.first_vertex},
         {"vertices", primitive.vertex_count},
         {"first_triangle", primitive.first_triangle},
         {"triangles", primitive.triangle_count}});
  return primitives;
}

Json describe_regions(const pack::PackView& view) {
  Json regions = Json::array();
  for (size_t r = 0; r < view.regions.size(); ++r) {
    const pack::RegionRecord& region = view.regions[r];
    const pack::RegionModesRecord& modes = view.region_modes[r];
    regions.push_back({{"name", string_at(view, region.name)},
                       {"nodes", region.node_count},
                       {"vertices", region.vertex_count},
                       {"modes", modes.mode_count},
                       {"first_hz", modes.first_rad_per_s / (2 * std::numbers::pi_v<float>)},
                       {"radius_m", region.radius_m},
                       {"displacement_limit_m", region.displacement_limit_m},
                       {"touches_body", region.touches_body != 0},
                       {"capsules", std::popcount(world::touchable_by(view, region))}});
    if (emulates_patches(view)) regions.back()["emulated_voxel_m"] = region.cell_m;  // 0: it is not
  }
  return regions;
}

Json describe_levels(const pack::PackView& view) {
  Json levels = Json::array();
  for (uint32_t l = 0; l < view.level_count; ++l) {
    const pack::LevelView& level = view.levels[l];
    uint32_t most = 0;
    Json left_out = Json::array();
    for (const pack::RegionRecord& region : level.regions) {
      most = std::max(most, region.node_count);
      if (region.node_count == 0) left_out.push_back(string_at(view, region.name));
    }
    levels.push_back({{"nodes", level.nodes.size()},
                      {"nodes_a_region", most},
                      {"left_out", left_out},
                      {"graph_entries", level.graph_columns.size()},
                      {"multiply_adds_a_tick",
                       multiply_adds(view.layers, level.nodes.size(), level.graph_columns.size())}});
  }
  return levels;
}

Json describe_rods(const pack::PackView& view) {
  Json rods = Json::array();
  for (const pack::RodRecord& rod : view.rods) {
    double length_m = 0, softest_pa = HUGE_VAL, stiffest_pa = 0;
    std::vector<const char*> bones;
    for (const pack::RodSegmentRecord& s : view.rod_segments.subspan(rod.first_segment, rod.segment_count)) {
      if (s.joint == pack::kNoIndex) continue;
      length_m +=
          std::hypot(double{s.end_m[0]} - double{s.begin_m[0]}, double{s.end_m[1]} - double{s.begin_m[1]},
                     double{s.end_m[2]} - double{s.begin_m[2]});
      softest_pa = std::min(softest_pa, double{s.young_modulus_pa});
      stiffest_pa = std::max(stiffest_pa, double{s.young_modulus_pa});
      bones.push_back(string_at(view, view.joints[s.joint].name));
    }
    rods.push_back(
        {{"name", string_at(view, rod.name)},
         {"hangs_on", string_at(view, view.joints[rod.attach].name)},
         {"end_held_by", rod.end_holder == 0 ? "" : string_at(view, view.joints[rod.end_holder - 1].name)},
         {"bones", bones.size()},
         {"first_hz", rod.frequency_hz},
         {"from", bones.front()},
         {"to", bones.back()},
         {"length_m", length_m},
         {"young_modulus_pa", Json::array({softest_pa, stiffest_pa})},
         {"gravity", rod.gravity},
         {"sag", rod.sag},
         {"turn_limit_rad", rod.turn_limit_rad},
         {"start", rod.start == 0 ? "continued" : "learned"}});
  }
  return rods;
}

Json describe_rod_network(const pack::ChainsView& chains) {
  return {{"model", pack::kModelNames[static_cast<size_t>(chains.record->model)]},
          {"latent", chains.record->max_channels},
          {"blocks", chains.record->blocks},
          {"depth", chains.record->depth},
          {"weights", chains.weights.size()}};
}

Json describe_patch_network(const pack::ChainsView& chains) {
  return {{"model", pack::kModelNames[static_cast<size_t>(chains.record->model)]},
          {"width", chains.layers.front().outputs},
          {"weights", chains.weights.size()}};
}

Json describe_clips(const pack::PackView& view) {
  Json clips = Json::array();
  for (const pack::ClipRecord& clip : view.clips)
    clips.push_back({{"name", string_at(view, clip.name)},
                     {"frames", clip.frame_count},
                     {"rate_hz", clip.rate_hz},
                     {"seconds", (static_cast<float>(clip.frame_count) - 1) / clip.rate_hz}});
  return clips;
}

std::string worst_motion(const pack::PackView& view, const pack::TierRecord& tier) {
  if (std::isnan(tier.worst_error_ratio)) return "-";
  if (tier.worst_clip == pack::kNoIndex) return "random or shake";
  return std::string(string_at(view, view.clips[tier.worst_clip].name));
}

Json describe_tiers(const pack::PackView& view) {
  constexpr const char* kNames[] = {"skinning", "extrapolate", "network", "", "modal"};
  Json tiers = Json::array();
  for (const pack::TierRecord& tier : view.tiers)
    tiers.push_back({{"tier", kNames[tier.tier]},
                     {"level", tier.level},
                     {"cost_us", tier.cost_us},
                     {"cost_p99_us", tier.cost_p99_us},
                     {"error_mm", tier.error_mm},
                     {"error_ratio", tier.error_ratio},
                     {"error_p95_mm", tier.error_p95_mm},
                     {"worst_ratio", tier.worst_error_ratio},
                     {"worst_along", worst_motion(view, tier)}});
  return tiers;
}

constexpr const char* dtype_name(Dtype dtype) {
  constexpr const char* kNames[] = {"F32", "F64", "F16", "I32", "I64", "U8", "BOOL"};
  return kNames[static_cast<size_t>(dtype)];
}

}  // namespace

Json describe_pack(const LoadedPack& pack) {
  const pack::PackView& view = pack.view();
  const bool is_character = view.kind == pack::FileKind::kCharacter;
  Json description = {{"kind", is_character ? "character" : "model"},
                      {"version", pack::kVersion},
                      {"bytes", pack.bytes().size()}};
  if (is_character) description["character"] = describe_character(view);
  description["network"] = describe_network(view);
  if (is_character) {
    description["meshes"] = describe_meshes(view);
    description["primitives"] = describe_primitives(view);
    description["regions"] = describe_regions(view);
    if (view.level_count > 1) description["levels"] = describe_levels(view);
    if (!view.rods.empty()) description["rods"] = describe_rods(view);
    if (view.rod_network.record) description["rod_network"] = describe_rod_network(view.rod_network);
    if (emulates_patches(view)) description["patch_network"] = describe_patch_network(view.patch_network);
    if (!view.proxies.empty()) description["proxies"] = view.proxies.size();
    description["clips"] = describe_clips(view);
    description["tiers"] = describe_tiers(view);
  }
  description["metadata"] = Json::parse(view.metadata.begin(), view.metadata.end(), nullptr, false);
  if (!description["metadata"].is_object()) description["metadata"] = Json::object();
  return description;
}

std::vector<std::string> notes_on(const pack::PackView& view) {
  std::vector<std::string> notes;
  const std::string all = view.proxies.empty()
                              ? "there are no capsules about bones: the recipe's without_proxies leaves them "
                                "out, or no bone moves "
                                "20 vertices"
                              : "touches none of the " + std::to_string(view.proxies.size()) +
                                    " capsules: each overlaps it in the bind pose or is of a bone that moves "
                                    "it; thinner ones (the "
                                    "recipe's \"proxies\") may be clear of it";
  for (const pack::RegionRecord& region : view.regions)
    if (region.touches_body && world::touchable_by(view, region) == 0)
      notes.push_back("region '" + std::string(string_at(view, region.name)) + "' says touches_body and " +
                      all);
  return notes;
}

Json describe_safetensors(const Safetensors& file) {
  Json tensors = Json::array();
  size_t bytes = 0, numbers = 0;
  for (const auto& [name, tensor] : file.tensors) {
    tensors.push_back({{"name", name}, {"dtype", dtype_name(tensor.dtype)}, {"shape", tensor.shape}});
    bytes += tensor.bytes.size();
    numbers += tensor.count();
  }
  return {{"kind", "safetensors"},
          {"bytes", bytes},
          {"numbers", numbers},
          {"tensors", tensors},
          {"metadata", file.metadata}};
}

}  // namespace sinew::baker

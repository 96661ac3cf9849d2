// proposal.cpp  From a layout to a recipe, and its text.
#include "baker/mesh/parts/proposal.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/parts/bone_pieces.hpp"
#include "baker/mesh/parts/named_parts.hpp"

namespace sinew::baker {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostOfPaint = 0.9;  // of a painted part's weight that its joints have

// To three digits: an artist edits them.
double rounded(double value) {
  if (value == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 2);
  return std::round(value / unit) * unit;
}

Json number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", rounded(value));
  return Json::parse(text);
}

// A painted part by the bones that move most of it.
Candidate painted_candidate(const Character& character, const TissueLayout& layout, const Region& region) {
  std::vector<std::pair<double, size_t>> weight(character.joint_node.size());
  for (size_t j = 0; j < weight.size(); ++j) weight[j].second = j;
  double all = 0;
  for (const int v : region.vertices) {
    const auto at = static_cast<size_t>(v);
    for (size_t k = 0; k < kInfluences; ++k) {
      const double share = (1 - layout.stiffness[at]) * character.skin[at].weight[k];
      weight[static_cast<size_t>(character.skin[at].joint[k])].first += share;
      all += share;
    }
  }
  std::ranges::sort(weight, std::greater{});
  const JointNames names(character);
  Candidate candidate;
  candidate.evidence = Evidence::kPainted;
  candidate.why = "painted _STIFFNESS";
  candidate.region.name = region.name;
  double sum = 0;
  for (const auto& [share, joint] : weight) {
    if (sum >= kMostOfPaint * all) break;
    candidate.region.joints.push_back(names.unique(joint));
    sum += share;
  }
  return candidate;
}

ProposedRod proposed(const Character& character, const TissueLayout& layout, const Rod& rod) {
  const JointNames names(character);
  ProposedRod proposed;
  const auto found = std::ranges::find(layout.found_rods, rod.name, &RodRecipe::name);
  if (rod.evidence == Evidence::kBoneName && found != layout.found_rods.end()) {
    proposed.rod = *found;
    proposed.why = "bone '" + rod.name + "'";
  } else {
    proposed.rod.name = rod.name;
    proposed.rod.root = names.unique(static_cast<size_t>(rod.bones.front().joint));
    proposed.rod.as_in_file = true;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "spring bone of the file; to change it put frequency_hz (now some %.3g) and damping_ratio in "
        "the place of as_in_file",
        rod.frequency_hz);
    proposed.why = text;
  }
  proposed.rod.max_displacement = rod.max_displacement;
  return proposed;
}

Json json_of(const RegionRecipe& region) {
  Json json;
  json["name"] = region.name;
  if (region.kind) json["kind"] = defaults_of(*region.kind).name;
  if (!region.joints.empty()) json["joints"] = region.joints;
  if (!region.mesh.empty()) json["mesh"] = region.mesh;
  if (!region.material.empty()) json["material"] = region.material;
  if (region.island_at) {
    const Vector3& at = *region.island_at;
    json["island_at"] = {number(at.x()), number(at.y()), number(at.z())};
  }
  if (region.frequency_hz) json["frequency_hz"] = number(*region.frequency_hz);
  if (region.damping_ratio) json["damping_ratio"] = number(*region.damping_ratio);
  if (region.max_displacement) json["max_displacement"] = number(*region.max_displacement);
  return json;
}

Json json_of(const RodRecipe& rod) {
  Json json;
  json["name"] = rod.name;
  json["root"] = rod.root;
  if (rod.as_in_file) {
    json["as_in_file"] = true;
  } else {
    json["frequency_hz"] = number(rod.frequency_hz);
    if (rod.damping_ratio) json["damping_ratio"] = number(*rod.damping_ratio);
    json["gravity"] = number(rod.gravity);
  }
  if (rod.max_displacement > 0) json["max_displacement"] = number(rod.max_displacement);
  return json;
}

std::string text_of_list(const Json& list) {
  std::string text;
  for (const Json& one : list) text += (text.empty() ? "" : ", ") + one.dump();
  return "[" + text + "]";
}

// A key a line, lists in one.
std::string text_of(const Json& entry) {
  std::string text = "    {";
  bool first = true;
  for (const auto& [key, value] : entry.items()) {
    text += (first ? "\n      " : ",\n      ") + Json(key).dump() + ": " +
            (value.is_array() ? text_of_list(value) : value.dump());
    first = false;
  }
  return text + "\n    }";
}

std::string list_of(const std::string& key, const std::vector<Json>& entries) {
  std::string text = "  \"" + key + "\": [";
  for (size_t i = 0; i < entries.size(); ++i) text += (i > 0 ? ",\n" : "\n") + text_of(entries[i]);
  return text + (entries.empty() ? "]" : "\n  ]");
}

// How the file was read, where that is not usual.
std::string keys_of_reading(const Recipe& recipe) {
  std::string text;
  if (recipe.unit_m > 0) text += "  \"unit_m\": " + number(recipe.unit_m).dump() + ",\n";
  if (recipe.up != Recipe{}.up) text += "  \"up\": \"" + std::string(1, recipe.up) + "\",\n";
  if (!recipe.without_meshes.empty())
    text += "  \"without_meshes\": " + text_of_list(recipe.without_meshes) + ",\n";
  if (!recipe.with_meshes.empty()) text += "  \"with_meshes\": " + text_of_list(recipe.with_meshes) + ",\n";
  return text;
}

Json with_note(const Json& part, bool enabled, const std::string& note) {
  Json json;
  json["enabled"] = enabled;
  json["note"] = note;
  json.update(part);
  return json;
}

}  // namespace

void state_numbers(const TissueLayout& layout, int index, RegionRecipe& region) {
  for (const Region& part : layout.regions) {
    if (part.recipe_region != index) continue;
    region.frequency_hz = std::max(region.frequency_hz.value_or(0), part.frequency_hz);
    region.max_displacement =
        std::min(region.max_displacement.value_or(part.max_displacement), part.max_displacement);
    region.damping_ratio = part.damping_ratio;
  }
}

Proposal propose(const Character& character, const TissueLayout& layout) {
  Proposal proposal;
  for (size_t r = 0; r < layout.found_regions.size(); ++r) {
    proposal.regions.push_back(layout.found_regions[r]);
    state_numbers(layout, static_cast<int>(r), proposal.regions.back().region);
  }
  for (const Region& region : layout.regions) {
    if (region.evidence != Evidence::kPainted) continue;
    Candidate painted = painted_candidate(character, layout, region);
    painted.region.frequency_hz = region.frequency_hz;
    painted.region.damping_ratio = region.damping_ratio;
    painted.region.max_displacement = region.max_displacement;
    proposal.regions.push_back(std::move(painted));
  }
  const bool painted = !character.stiffness.empty();
  for (const BonePiece& piece :
       painted ? std::vector<BonePiece>{} : bone_pieces(character, find_surface(character)))
    if (!piece.is_named) proposal.regions.push_back({piece.region, Evidence::kShape, piece.why, piece.doubt});
  std::set<std::string> taken;
  for (Candidate& part : proposal.regions) {
    const std::string name = part.region.name;
    for (int number = 2; !taken.insert(part.region.name).second; ++number)
      part.region.name = name + "_" + std::to_string(number);
  }
  std::stable_partition(proposal.regions.begin(), proposal.regions.end(),
                        [](const Candidate& c) { return c.doubt.empty(); });
  for (const Rod& rod : layout.rods) proposal.rods.push_back(proposed(character, layout, rod));
  return proposal;
}

Recipe recipe_of(const std::vector<Candidate>& regions, const std::vector<ProposedRod>& rods) {
  Recipe recipe;
  recipe.states_regions = true;
  for (const Candidate& candidate : regions) recipe.regions.push_back(candidate.region);
  if (!rods.empty()) recipe.rods.emplace();
  for (const ProposedRod& rod : rods) recipe.rods->push_back(rod.rod);
  return recipe;
}

std::string proposal_text(const Proposal& proposal, const Recipe& read_by, const std::string& file) {
  size_t count = 0;
  std::vector<Json> regions, rods;
  for (const Candidate& part : proposal.regions) {
    const std::string note =
        std::to_string(++count) + ": " + part.why + (part.doubt.empty() ? "" : "; in doubt: " + part.doubt);
    regions.push_back(with_note(json_of(part.region), part.doubt.empty(), note));
  }
  for (const ProposedRod& rod : proposal.rods)
    rods.push_back(with_note(json_of(rod.rod), true, std::to_string(++count) + ": " + rod.why));
  const std::string note = "What may swing of " + std::filesystem::path(file).filename().string() +
                           "; numbers are those of the preview. A part that is not enabled is in doubt, and "
                           "one that is taken out stays rigid.";
  std::string text =
      "{\n  \"note\": " + Json(note).dump() + ",\n" + keys_of_reading(read_by) + list_of("regions", regions);
  if (!rods.empty()) text += ",\n" + list_of("rods", rods);
  return text + "\n}\n";
}

}  // namespace sinew::baker

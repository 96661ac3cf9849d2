// describe_audit.cpp  One row a part, one a tier.
#include "baker/audit/describe_audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "baker/audit/bounds.hpp"
#include "sinew/types.hpp"

namespace sinew::baker {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTierNames[] = {"skinning", "extrapolate", "network", "", "modal"};

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json moment(const Moment& worst, double unit = 1) {
  return {{"value", finite(worst.value / unit)}, {"motion", worst.motion}, {"tick", worst.tick}};
}

Json layers(const PartAudit& part) {
  if (!part.layers.any()) return nullptr;
  return {{"least_m", part.layers.least_m},
          {"largest_m", part.layers.largest_m},
          {"file_least_m", part.layers.file_least_m},
          {"file_largest_m", part.layers.file_largest_m},
          {"crossed_m", moment(part.layers_cross_m)}};
}

// Of the character's vertices.
double moving_share(const PartAudit& part, const Audit& audit) {
  return static_cast<double>(part.moving) / static_cast<double>(std::max<size_t>(1, audit.vertices));
}

std::string number(double value, const char* otherwise) {
  if (!std::isfinite(value)) return otherwise;
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string percent(double share) { return number(100 * share, "-") + " %"; }

std::string range_mm(double least_m, double largest_m) {
  return number(1e3 * least_m, "-") + " .. " + number(1e3 * largest_m, "-");
}

// Columns as wide as their widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> width(rows.front().size(), 0);
  for (const auto& row : rows)
    for (size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (size_t c = 0; c < row.size(); ++c) line += row[c] + std::string(width[c] - row[c].size() + 2, ' ');
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

}  // namespace

Json audit_json(const Audit& audit, const AuditedPack& pack) {
  Json parts = Json::array(), tiers = Json::array();
  for (const PartAudit& part : audit.parts)
    parts.push_back({{"name", part.part.name},
                     {"kind", part.part.is_rod ? "rod" : "region"},
                     {"size_m", part.part.size_m},
                     {"first_hz", finite(part.part.first_hz)},
                     {"displacement_of_size", moment(part.displacement_m, part.part.size_m)},
                     {"displacement_of_height", moment(part.displacement_m, audit.height_m)},
                     {"bob_displacement_of_height", finite(part.bob_m / audit.height_m)},
                     {"edge_stretch", moment(part.edge_stretch)},
                     {"inverted_share", moment(part.inverted_share)},
                     {"residual_of_height", finite(part.residual_m / audit.height_m)},
                     {"moving_share", moving_share(part, audit)},
                     {"layer_gap", layers(part)}});
  for (const pack::TierRecord& tier : pack.view.tiers)
    tiers.push_back({{"tier", kTierNames[tier.tier]},
                     {"level", tier.level},
                     {"error_mm", finite(static_cast<double>(tier.error_mm))},
                     {"error_ratio", finite(static_cast<double>(tier.error_ratio))}});
  double moving = 0;
  for (const PartAudit& part : audit.parts) moving += moving_share(part, audit);
  return {{"height_m", audit.height_m},
          {"moving_share", moving},
          {"bounds",
           {{"edge_stretch", kMostEdgeStretch},
            {"inverted_share", kMostInverted},
            {"residual_of_height", kMostResidual},
            {"bob_displacement_of_height", kMostDisplacement},
            {"crossed_of_height", kMostCrossing}}},
          {"parts", parts},
          {"tiers", tiers},
          {"failures", audit.failures},
          {"ok", audit.failures.empty()}};
}

std::string audit_table(const Audit& audit, const AuditedPack& pack) {
  std::vector<std::vector<std::string>> rows = {{"part", "kind", "Hz", "moved/size", "moved/height",
                                                 "bob/height", "moving", "stretch", "inverted",
                                                 "residual/height", "layers mm", "skinned mm", "worst in"}};
  for (const PartAudit& part : audit.parts)
    rows.push_back({part.part.name, part.part.is_rod ? "rod" : "region", number(part.part.first_hz, "-"),
                    number(part.displacement_m.value / part.part.size_m, "NaN"),
                    number(part.displacement_m.value / audit.height_m, "NaN"),
                    number(part.bob_m / audit.height_m, "NaN"), percent(moving_share(part, audit)),
                    number(part.edge_stretch.value, "NaN"), number(part.inverted_share.value, "NaN"),
                    number(part.residual_m / audit.height_m, "-"),
                    part.layers.any() ? range_mm(part.layers.least_m, part.layers.largest_m) : "-",
                    part.layers.any() ? range_mm(part.layers.file_least_m, part.layers.file_largest_m) : "-",
                    part.displacement_m.motion});
  std::string out = aligned(rows);
  rows = {{"tier", "level", "error mm", "of skinning"}};
  for (const pack::TierRecord& tier : pack.view.tiers)
    if (tier.tier != static_cast<uint32_t>(Tier::kSkinning))
      rows.push_back({kTierNames[tier.tier], std::to_string(tier.level),
                      number(static_cast<double>(tier.error_mm), "not measured"),
                      number(static_cast<double>(tier.error_ratio), "not measured")});
  return out + aligned(rows);
}

}  // namespace sinew::baker

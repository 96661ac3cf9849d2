// row.cpp  see row.hpp.
#include "baker/trade/row.hpp"

namespace sinew::baker {
namespace {

nlohmann::ordered_json to_json(const Cost& cost) {
  return {{"p50_us", cost.p50_us}, {"p99_us", cost.p99_us}, {"mean_us", cost.mean_us}};
}

Cost cost_from(const nlohmann::json& json) {
  return {json.at("p50_us"), json.at("p99_us"), json.at("mean_us")};
}

}  // namespace

nlohmann::ordered_json to_json(const Row& row) {
  return {{"name", row.name},
          {"kind", row.kind},
          {"tier", static_cast<uint32_t>(row.tier)},
          {"every", row.every},
          {"bought", row.is_bought()},
          {"level", row.level},
          {"warm", to_json(row.warm)},
          {"cold", to_json(row.cold)},
          {"mean_mm", row.error.mean_mm},
          {"sd_mm", row.error.sd_mm},
          {"p95_mm", row.error.p95_mm},
          {"worst_mm", row.error.worst_mm},
          {"ratio", row.error.ratio},
          {"ratio_50", row.error.ratio_50},
          {"dominated_by", row.dominated_by}};
}

Row row_from(const nlohmann::json& json) {
  return {.name = json.at("name"),
          .kind = json.at("kind"),
          .tier = static_cast<Tier>(json.at("tier").get<uint32_t>()),
          .every = json.at("every"),
          .level = json.at("level"),
          .warm = cost_from(json.at("warm")),
          .cold = cost_from(json.at("cold")),
          .error = {json.at("mean_mm"), json.at("sd_mm"), json.at("p95_mm"), json.at("worst_mm"),
                    json.at("ratio"), json.at("ratio_50")},
          .dominated_by = json.at("dominated_by")};
}

}  // namespace sinew::baker

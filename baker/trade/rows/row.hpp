// row.hpp  A way to run a character, and what was measured of it.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "baker/measure/yardstick.hpp"
#include "sinew/types.hpp"

namespace sinew::baker {

// Of one step of one instance, microseconds of the thread's own time.
struct Cost {
  double p50_us = 0, p99_us = 0;
};

struct Row {
  std::string name;
  std::string kind;  // "tier": of the character itself; "variant": of one baked otherwise; "baseline": none
  Tier tier = Tier::kSkinning;
  uint32_t level = 0;  // of control graphs
  Cost warm, cold;
  Error error;
  std::string dominated_by;  // empty: on the front

  bool costs() const { return kind != "baseline"; }
};

nlohmann::ordered_json to_json(const Row& row);
// What was measured, without what is found by comparison. Nothing where a number is missing, is none, not
// finite or below zero, where a step that costs took no time, or where there is no such tier.
std::optional<Row> row_from(const nlohmann::json& json);

}  // namespace sinew::baker

// row.cpp  see row.hpp.
#include "baker/trade/rows/row.hpp"

#include <cmath>

namespace sinew::baker {
namespace {

nlohmann::ordered_json to_json(const Cost& cost) {
  return {{"p50_us", cost.p50_us}, {"p99_us", cost.p99_us}};
}

nlohmann::ordered_json to_json(const Spread& spread) {
  return {{"mean_mm", spread.mean_mm},
          {"sd_mm", spread.sd_mm},
          {"p95_mm", spread.p95_mm},
          {"worst_mm", spread.worst_mm},
          {"ratio", spread.ratio}};
}

// Takes numbers out of an object, and remembers whether all were there.
class Reader {
 public:
  explicit Reader(const nlohmann::json& json) : json_(json) {}
  std::string text(const char* key) {
    is_whole_ &= has(key) && json_.at(key).is_string();
    return is_whole_ ? json_.at(key).get<std::string>() : "";
  }
  uint32_t count(const char* key) {
    is_whole_ &=
        has(key) && json_.at(key).is_number_unsigned() && json_.at(key).get<uint64_t>() <= UINT32_MAX;
    return is_whole_ ? json_.at(key).get<uint32_t>() : 0;
  }
  double number(const char* key) {
    is_whole_ &= has(key) && json_.at(key).is_number() && json_.at(key).get<double>() >= 0 &&
                 std::isfinite(json_.at(key).get<double>());
    return is_whole_ ? json_.at(key).get<double>() : 0;
  }
  Cost cost(const char* key) {
    is_whole_ &= has(key);
    if (!is_whole_) return {};
    Reader inner(json_.at(key));
    const Cost out{inner.number("p50_us"), inner.number("p99_us")};
    is_whole_ &= inner.is_whole();
    return out;
  }
  Spread spread() {
    return {number("mean_mm"), number("sd_mm"), number("p95_mm"), number("worst_mm"), number("ratio")};
  }
  Spread spread(const char* key) {
    is_whole_ &= has(key);
    if (!is_whole_) return {};
    Reader inner(json_.at(key));
    const Spread out = inner.spread();
    is_whole_ &= inner.is_whole();
    return out;
  }
  bool is_whole() const { return is_whole_; }

 private:
  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }

  const nlohmann::json& json_;
  bool is_whole_ = true;
};

bool took_time(const Cost& cost) { return cost.p50_us > 0 && cost.p99_us > 0; }

bool is_possible(const Row& row) {
  const bool is_kind = row.kind == "tier" || row.kind == "variant" || row.kind == "baseline";
  return is_kind && static_cast<uint32_t>(row.tier) < kTierCount &&
         (!row.costs() || (took_time(row.warm) && took_time(row.cold)));
}

}  // namespace

nlohmann::ordered_json to_json(const Row& row) {
  return {{"name", row.name},
          {"kind", row.kind},
          {"tier", static_cast<uint32_t>(row.tier)},
          {"level", row.level},
          {"warm", to_json(row.warm)},
          {"cold", to_json(row.cold)},
          {"mean_mm", row.error.mean_mm},
          {"sd_mm", row.error.sd_mm},
          {"p95_mm", row.error.p95_mm},
          {"worst_mm", row.error.worst_mm},
          {"ratio", row.error.ratio},
          {"in_50", to_json(row.error.in_50)},
          {"dominated_by", row.dominated_by}};
}

std::optional<Row> row_from(const nlohmann::json& json) {
  Reader read(json);
  Row row;
  row.name = read.text("name");
  row.kind = read.text("kind");
  row.tier = static_cast<Tier>(read.count("tier"));
  row.level = read.count("level");
  row.warm = read.cost("warm");
  row.cold = read.cost("cold");
  row.error = {read.spread(), read.spread("in_50")};
  return read.is_whole() && is_possible(row) ? std::optional(row) : std::nullopt;
}

}  // namespace sinew::baker

// table.cpp  see table.hpp.
#include "baker/trade/report/table.hpp"

#include <cstdio>

namespace sinew::baker {
namespace {

template <class... Values>
std::string printed(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string costs_of(const Row& row) {
  if (!row.costs()) return printed("%8s %8s %9s %9s", "-", "-", "-", "-");
  return printed("%8.1f %8.1f %9.1f %9.1f", row.warm.p50_us, row.warm.p99_us, row.cold.p50_us,
                 row.cold.p99_us);
}

std::string heads_of(const char* mean) {
  return printed("%8s %8s %8s %8s %8s", mean, "sd", "p95", "worst", "of skin.");
}

std::string spread_of(const Spread& e) {
  return printed("%8.3f %8.3f %8.3f %8.2f %8.4f", e.mean_mm, e.sd_mm, e.p95_mm, e.worst_mm, e.ratio);
}

std::string listed(const Spread& e) {
  return printed("%.4f,%.4f,%.4f,%.3f,%.5f", e.mean_mm, e.sd_mm, e.p95_mm, e.worst_mm, e.ratio);
}

std::string verdict_of(const Row& row) {
  if (row.kind == "baseline") return "baseline";
  std::string verdict = row.dominated_by.empty() ? "" : "dominated by " + row.dominated_by;
  return row.kind == "variant" ? "variant; " + (verdict.empty() ? "on the front" : verdict) : verdict;
}

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
}

}  // namespace

std::string as_table(const Measured& measured) {
  std::string out = printed("%s on %s: a step of one instance, us; errors over %zu vertices\n",
                            measured.character.c_str(), measured.processor.c_str(), measured.vertices);
  for (const std::string& motion : measured.motions) out += "against " + motion + "\n";
  out += printed("%-30s %8s %8s %9s %9s  %s  %s\n", "", "p50", "p99", "cold p50", "cold p99",
                 heads_of("error mm").c_str(), heads_of("50 ticks").c_str());
  for (const Row& row : measured.rows) {
    out += printed("%-30s %s  %s  %s  %s\n", row.name.c_str(), costs_of(row).c_str(),
                   spread_of(row.error).c_str(), spread_of(row.error.in_50).c_str(), verdict_of(row).c_str());
  }
  return out;
}

std::string as_csv(const Measured& measured) {
  std::string out = printed("# %s, %s, %zu vertices\n", measured.character.c_str(),
                            measured.processor.c_str(), measured.vertices);
  for (const std::string& motion : measured.motions) out += "# " + motion + "\n";
  out += "name,kind,level,warm_p50_us,warm_p99_us,cold_p50_us,";
  out += "cold_p99_us,mean_mm,sd_mm,p95_mm,worst_mm,ratio,";
  out += "mean_50_mm,sd_50_mm,p95_50_mm,worst_50_mm,ratio_50,dominated_by\n";
  for (const Row& row : measured.rows) {
    out +=
        printed("%s,%s,%u,%.2f,%.2f,%.2f,%.2f,%s,%s,%s\n", quoted(row.name).c_str(), row.kind.c_str(),
                row.level, row.warm.p50_us, row.warm.p99_us, row.cold.p50_us, row.cold.p99_us,
                listed(row.error).c_str(), listed(row.error.in_50).c_str(), quoted(row.dominated_by).c_str());
  }
  return out;
}

std::string as_json(const Measured& measured) {
  nlohmann::ordered_json out = {{"character", measured.character},
                                {"processor", measured.processor},
                                {"motions", measured.motions},
                                {"vertices", measured.vertices},
                                {"rows", nlohmann::json::array()}};
  for (const Row& row : measured.rows) out["rows"].push_back(to_json(row));
  return out.dump(1) + "\n";
}

}  // namespace sinew::baker

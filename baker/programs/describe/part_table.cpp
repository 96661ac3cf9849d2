// part_table.cpp  see part_table.hpp.
#include "baker/programs/describe/part_table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <vector>

namespace sinew::baker {
namespace {

constexpr size_t kColumns = 6, kMostNames = 48;  // characters of a joined name
using Row = std::array<std::string, kColumns>;

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

Row row_of(const Region& region, float first_rad_per_s, float limit_m) {
  const float radius_m = static_cast<float>(region.radius_m);
  return {region.name,
          name_of(region.evidence),
          defaults_of(region.kind).name,
          text("%.2f", static_cast<double>(first_rad_per_s) / (2 * std::numbers::pi)),
          text("%.2f (%.3g m)", static_cast<double>(limit_m / radius_m), static_cast<double>(limit_m)),
          "soft tissue"};
}

Row row_of(const Rod& rod) {
  const auto bones = std::ranges::count_if(rod.bones, [](const RodBone& bone) { return bone.joint >= 0; });
  return {rod.name,
          name_of(rod.evidence),
          defaults_of(rod.kind).name,
          text("%.2f", rod.frequency_hz),
          rod.max_displacement > 0 ? text("%.2f", rod.max_displacement) : "-",
          text("rod of %d bone%s", static_cast<int>(bones), bones == 1 ? "" : "s")};
}

// Those with one reason share a line.
std::vector<Row> rows_of(const std::vector<SkippedPart>& skipped) {
  std::vector<Row> rows;
  for (const SkippedPart& part : skipped) {
    const Row row = {part.part, name_of(part.evidence), defaults_of(part.kind).name, "-",
                     "-",       "rigid: " + part.why};
    const auto same = std::ranges::find_if(rows, [&](const Row& other) {
      return std::equal(row.begin() + 1, row.end(), other.begin() + 1) &&
             other[0].size() + row[0].size() < kMostNames;
    });
    if (same == rows.end())
      rows.push_back(row);
    else
      (*same)[0] += ", " + row[0];
  }
  return rows;
}

}  // namespace

std::string part_table(const TissueLayout& layout, const pack::PackView& pack) {
  std::vector<Row> rows = {{"part", "evidence", "kind", "Hz", "limit/size", ""}};
  for (size_t r = 0; r < layout.regions.size(); ++r)
    rows.push_back(row_of(layout.regions[r], pack.region_modes[r].first_rad_per_s,
                          pack.regions[r].displacement_limit_m));
  for (const Rod& rod : layout.rods) rows.push_back(row_of(rod));
  std::ranges::move(rows_of(layout.skipped), std::back_inserter(rows));
  if (rows.size() == 1) return "";
  std::array<size_t, kColumns> width{};
  for (const Row& row : rows)
    for (size_t c = 0; c < kColumns; ++c) width[c] = std::max(width[c], row[c].size());
  std::string table;
  for (const Row& row : rows) {
    std::string line;
    for (size_t c = 0; c < kColumns; ++c) line += row[c] + std::string(width[c] + 2 - row[c].size(), ' ');
    table += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return table;
}

}  // namespace sinew::baker

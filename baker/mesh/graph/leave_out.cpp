// leave_out.cpp  see leave_out.hpp.
#include "baker/mesh/graph/leave_out.hpp"

#include <algorithm>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

bool matches(const std::string& region, const std::string& name) {
  if (name.ends_with('*')) return region.starts_with(name.substr(0, name.size() - 1));
  return region == name;
}

std::string names_of(const std::vector<Region>& regions) {
  std::string names;
  for (const Region& region : regions) names += (names.empty() ? "'" : ", '") + region.name + "'";
  return names;
}

std::vector<bool> left_out(const std::vector<Region>& regions, const std::vector<std::string>& names,
                           const std::string& where) {
  std::vector<bool> out(regions.size(), false);
  for (const std::string& name : names) {
    bool found = false;
    for (size_t r = 0; r < regions.size(); ++r)
      if (matches(regions[r].name, name)) out[r] = found = true;
    if (!found) throw BadInput(where + ": no region is named '" + name + "'; there are " + names_of(regions));
  }
  if (std::ranges::find(out, false) == out.end())
    throw BadInput(where + ": leaves out all of " + names_of(regions) + "; keep one");
  return out;
}

}  // namespace

TissueLayout leave_out(const TissueLayout& layout, const std::vector<std::string>& names,
                       const std::string& where) {
  const std::vector<bool> out = left_out(layout.regions, names, where);
  TissueLayout kept = layout;
  kept.nodes.clear();
  kept.edges.clear();
  std::vector<int> now(layout.nodes.size(), -1);  // its index among those kept
  for (size_t n = 0; n < layout.nodes.size(); ++n) {
    if (out[static_cast<size_t>(layout.nodes[n].region)]) continue;
    now[n] = static_cast<int>(kept.nodes.size());
    kept.nodes.push_back(layout.nodes[n]);
  }
  for (const auto& [a, b] : layout.edges)
    if (now[static_cast<size_t>(a)] >= 0)
      kept.edges.emplace_back(now[static_cast<size_t>(a)], now[static_cast<size_t>(b)]);
  int first = 0;
  for (size_t r = 0; r < kept.regions.size(); ++r) {
    Region& region = kept.regions[r];
    region.first_node = first;
    if (out[r]) region.node_count = 0, region.carry.clear();
    first += region.node_count;
  }
  return kept;
}

}  // namespace sinew::baker

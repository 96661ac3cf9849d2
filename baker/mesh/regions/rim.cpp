// rim.cpp  A slope's largest value, from above and from below.
#include "baker/mesh/regions/rim.hpp"

#include <algorithm>
#include <queue>

namespace sinew::baker {
namespace {

// Raises `value` to the largest function below `most` that falls by at most `slope` a metre from where it
// is; Dijkstra with the highest first.
template <class Most>
void spread(const Character& character, const Surface& surface, double slope, Most most,
            std::vector<double>& value) {
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry> open;
  for (size_t v = 0; v < value.size(); ++v) open.push({value[v], static_cast<int>(v)});
  while (!open.empty()) {
    const auto [reached, vertex] = open.top();
    open.pop();
    const auto at = static_cast<size_t>(vertex);
    if (reached < value[at]) continue;
    for (const int other : surface.neighbours[at]) {
      const auto next = static_cast<size_t>(other);
      const double way = (character.positions[next] - character.positions[at]).norm();
      const double raised = std::min(reached - slope * way, most(next));
      if (raised <= value[next]) continue;
      value[next] = raised;
      open.push({raised, other});
    }
  }
}

constexpr double kMostStretch = 0.25, kSteepest = 2;
constexpr double kFewestEdges = 3;
constexpr double kMostRadii = 1.5;  // wider, little of the region is left that is soft
constexpr double kSoft = 0.5;       // what counts as the region

}  // namespace

double rim_width_m(const Character& character, const Surface& surface, const std::vector<double>& softness,
                   double wanted_share) {
  Vector3 centre = Vector3::Zero();
  double count = 0, radius = 0, edge = 0, edges = 0;
  const auto counts = [&](size_t v) {
    return softness[v] > kSoft && character.welded[v] == static_cast<int>(v);
  };
  for (size_t v = 0; v < softness.size(); ++v) {
    if (!counts(v)) continue;
    centre += character.positions[v];
    ++count;
    for (const int next : surface.neighbours[v])
      edge += (character.positions[static_cast<size_t>(next)] - character.positions[v]).norm(), ++edges;
  }
  if (!(count > 0 && edges > 0)) return 0;
  centre /= count;
  for (size_t v = 0; v < softness.size(); ++v)
    if (counts(v)) radius = std::max(radius, (character.positions[v] - centre).norm());
  const double wanted = std::min(kSteepest * wanted_share / kMostStretch, kMostRadii) * radius;
  return std::max(wanted, kFewestEdges * edge / edges);
}

void fade_rim(const Character& character, const Surface& surface, const std::vector<double>& open,
              double width_m, std::vector<double>& softness) {
  if (!(width_m > 0)) return;
  spread(
      character, surface, 1 / width_m, [&](size_t v) { return open[v]; }, softness);
  // What is rigid spreads inwards in the same way.
  for (double& soft : softness) soft = 1 - soft;
  spread(
      character, surface, 1 / width_m, [](size_t) { return 1.0; }, softness);
  for (double& soft : softness) soft = 1 - soft;
}

}  // namespace sinew::baker

// front.cpp  see front.hpp.
#include "baker/trade/rows/front.hpp"

namespace sinew::baker {
namespace {

bool is_simulated(const Row& row) { return row.costs() && row.tier >= Tier::kNetwork; }

bool dominates(const Row& a, const Row& b) {
  const bool no_worse = a.warm.p50_us <= b.warm.p50_us && a.error.ratio <= b.error.ratio;
  return no_worse && (a.warm.p50_us < b.warm.p50_us || a.error.ratio < b.error.ratio);
}

// The nearest to the truth of those that do.
std::string dominator(const Row& row, const std::vector<Row>& rows) {
  const Row* best = nullptr;
  for (const Row& other : rows) {
    const bool may = other.kind == "tier" || row.kind == "variant";
    if (!may || !other.costs() || other.tier == Tier::kExtrapolate || !dominates(other, row)) continue;
    if (!best || other.error.ratio < best->error.ratio) best = &other;
  }
  return best ? best->name : "";
}

}  // namespace

void find_dominated(std::vector<Row>* rows) {
  for (Row& row : *rows) row.dominated_by = is_simulated(row) ? dominator(row, *rows) : "";
}

}  // namespace sinew::baker

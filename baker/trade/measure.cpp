// measure.cpp  see measure.hpp.
#include "baker/trade/measure.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "baker/common/progress.hpp"
#include "baker/measure/yardstick.hpp"
#include "baker/trade/cost.hpp"
#include "baker/trade/rows/front.hpp"

namespace sinew::baker {
namespace {

struct Way {
  std::string name, kind;
  Tier tier;
  uint32_t level;
  std::function<void(Row*)> measure;
};

uint32_t nodes_a_region(const LoadedPack& character, uint32_t level) {
  uint32_t most = 0;
  for (const pack::RegionRecord& region : character.view().levels[level].regions)
    most = std::max(most, region.node_count);
  return most;
}

std::string left_out(const LoadedPack& character, uint32_t level) {
  std::string names;
  for (const pack::RegionRecord& region : character.view().levels[level].regions)
    if (region.node_count == 0)
      names += (names.empty() ? " without " : " and ") +
               std::string(pack::string_at(character.view(), region.name));
  return names;
}

std::string name_of(const LoadedPack& character, Tier tier, uint32_t level) {
  constexpr const char* kNames[] = {"skinning", "extrapolate", "network", "", "modal"};
  std::string name = kNames[static_cast<size_t>(tier)];
  if (level == 0) return name;
  name += " on " + std::to_string(nodes_a_region(character, level)) + " nodes";
  return name + left_out(character, level);
}

class Ways {
 public:
  Ways(const Yardstick& yardstick, const TrueMotion& motion) : yardstick_(yardstick), motion_(motion) {}

  void add_tier(const LoadedPack& character, Tier tier, uint32_t level) {
    ways_.push_back({name_of(character, tier, level), "tier", tier, level, [=, this, &character](Row* row) {
                       if (!crowd_) crowd_.emplace(character, motion_);
                       tell_cost(character, *crowd_, row);
                       row->error = tier == Tier::kSkinning ? yardstick_.of_skinning()
                                    : tier == Tier::kExtrapolate
                                        ? yardstick_.of_extrapolation(character, kCarriedTicks)
                                        : yardstick_.of(character, tier, level);
                     }});
  }
  void add_baselines(const LoadedPack& character) {
    ways_.push_back({"previous frame's displacement", "baseline", Tier::kSkinning, 0,
                     [this](Row* row) { row->error = yardstick_.of_previous_frame(); }});
    for (const size_t ticks : {1, 2, 8})
      ways_.push_back(
          {"extrapolate, after " + std::to_string(ticks), "baseline", Tier::kExtrapolate, 0,
           [=, this, &character](Row* row) { row->error = yardstick_.of_extrapolation(character, ticks); }});
  }
  void add_variant(const LoadedPack& character, const Variant& variant, Tier tier) {
    const std::string name = name_of(character, tier, 0) + ", " + variant.name;
    ways_.push_back({name, "variant", tier, 0, [=, this](Row* row) {
                       const LoadedPack baked = variant.bake();
                       crowd_.reset();  // memory for one at a time
                       Crowd crowd(baked, motion_);
                       tell_cost(baked, crowd, row);
                       row->error = yardstick_.of(baked, tier, 0);
                     }});
  }
  const std::vector<Way>& all() const { return ways_; }

 private:
  void tell_cost(const LoadedPack& character, Crowd& crowd, Row* row) const {
    row->warm = warm_cost(character, motion_, row->tier, row->level);
    row->cold = crowd.cold_cost(row->tier, row->level);
  }

  const Yardstick& yardstick_;
  const TrueMotion& motion_;
  std::optional<Crowd> crowd_;  // of the character itself, from the first tier that is measured on
  std::vector<Way> ways_;
};

void add_tiers(const LoadedPack& character, Ways* to) {
  to->add_tier(character, Tier::kSkinning, 0);
  to->add_tier(character, Tier::kExtrapolate, 0);
  for (const Tier tier : {Tier::kModal, Tier::kNetwork}) {
    if (tier == Tier::kNetwork && !pack::affords_network(character.view())) continue;
    for (uint32_t level = 0; level < character.view().level_count; ++level)
      to->add_tier(character, tier, level);
  }
}

// A character with coarser control graphs of its own is not baked with others to compare.
void add_variants(const LoadedPack& character, std::span<const Variant> variants, Ways* to) {
  for (const Variant& variant : variants) {
    const bool is_graph = variant.name.ends_with("nodes a region");
    if (is_graph && character.view().level_count > 1) continue;
    to->add_variant(character, variant, Tier::kNetwork);
    if (is_graph) to->add_variant(character, variant, Tier::kModal);
  }
}

Row unmeasured(const Way& way) {
  Row row;
  row.name = way.name;
  row.kind = way.kind;
  row.tier = way.tier;
  row.level = way.level;
  return row;
}

}  // namespace

Measurement measure(const LoadedPack& character, std::span<const TrueSurface> surfaces,
                    std::span<const Variant> variants, RowCache& cache) {
  const Yardstick yardstick(character, surfaces);
  Ways ways(yardstick, surfaces.front().motion());
  add_tiers(character, &ways);
  ways.add_baselines(character);
  add_variants(character, variants, &ways);
  Progress progress("measuring", ways.all().size());
  std::vector<Row> rows;
  size_t measured_before = 0;
  for (const Way& way : ways.all()) {
    Row row = unmeasured(way);
    if (const std::optional<Row> known = cache.find(row)) {
      row = *known;
      ++measured_before;
    } else {
      way.measure(&row);
      cache.add(row);
    }
    rows.push_back(row);
    progress.update(rows.size());
  }
  find_dominated(&rows);
  return {.rows = std::move(rows), .measured_before = measured_before};
}

}  // namespace sinew::baker

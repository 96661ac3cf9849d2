// front.cpp  Which rows are worth having, and what of them is baked.
#include "baker/trade/rows/front.hpp"

#include <catch2/catch.hpp>

#include "baker/trade/report/write_tiers.hpp"

using namespace sinew;
using namespace sinew::baker;

namespace {

Row row(const std::string& name, const std::string& kind, Tier tier, double us, double ratio,
        uint32_t level = 0) {
  Row out;
  out.name = name;
  out.kind = kind;
  out.tier = tier;
  out.level = level;
  out.warm = {us, 2 * us};
  out.error.ratio = ratio;
  out.error.mean_mm = 10 * ratio;
  return out;
}

std::vector<Row> rows() {
  return {row("skinning", "tier", Tier::kSkinning, 2, 1),
          row("extrapolate", "tier", Tier::kExtrapolate, 1, 0.01),
          row("coarser", "tier", Tier::kModal, 40, 0.4, 1),
          row("modal", "tier", Tier::kModal, 30, 0.2),
          row("coarsest", "tier", Tier::kModal, 35, 0.25, 2),
          row("network", "tier", Tier::kNetwork, 100, 0.1),
          row("cheap", "variant", Tier::kNetwork, 25, 0.05),
          row("dear", "variant", Tier::kNetwork, 99, 0.06),
          row("previous", "baseline", Tier::kSkinning, 0, 0.001)};
}

}  // namespace

// Extrapolate and baselines would dominate all others by their numbers; variants are no tiers to be had.
TEST_CASE("a_row_is_dominated_by_what_is_cheaper_and_nearer_and_to_be_had") {
  std::vector<Row> all = rows();
  find_dominated(&all);
  const char* const wanted[] = {"", "", "modal", "", "modal", "", "", "cheap", ""};
  for (size_t i = 0; i < all.size(); ++i) {
    INFO(all[i].name);
    CHECK(all[i].dominated_by == wanted[i]);
  }
}

TEST_CASE("equal_rows_do_not_dominate_each_other") {
  std::vector<Row> two = {row("a", "tier", Tier::kModal, 30, 0.2), row("b", "tier", Tier::kNetwork, 30, 0.2)};
  find_dominated(&two);
  CHECK(two[0].dominated_by.empty());
  CHECK(two[1].dominated_by.empty());
}

TEST_CASE("dominated_tiers_are_not_baked_but_what_others_fall_back_to_is") {
  std::vector<Row> all = rows();
  all[3].warm.p50_us = 200;  // modal, dominated: but networks fall back to it
  find_dominated(&all);
  REQUIRE(all[3].dominated_by == "network");
  const std::vector<pack::TierRecord> tiers = tier_records(all);
  std::vector<uint32_t> kept;
  for (const pack::TierRecord& tier : tiers) kept.push_back(tier.tier);
  CHECK(kept == std::vector<uint32_t>{0, 1, 2, 4, 4});
  CHECK(tiers[0].cost_us == 2);  // what every step takes
  CHECK(tiers[1].cost_us == 0);  // beyond it, and never less than nothing
  CHECK(tiers[2].cost_us == 98);
  CHECK(tiers[2].cost_p99_us == 198);
  CHECK(tiers[2].error_ratio == 0.1f);
  CHECK(tiers[2].error_mm == 1.0f);
}

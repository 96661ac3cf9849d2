// tier_pack.cpp  Baked costs and errors.
#include "baker/pack/character/tier_pack.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "sinew/types.hpp"

using namespace sinew;
using namespace sinew::baker;

namespace {

pack::LayerRecord layer(uint32_t inputs, uint32_t channels, uint32_t has_self) {
  pack::LayerRecord record{};
  record.inputs = inputs;
  record.channels = channels;
  record.padded = (channels + 15) / 16 * 16;
  record.has_self = has_self;
  return record;
}

constexpr Tier kAll[] = {Tier::kSkinning, Tier::kExtrapolate, Tier::kNetwork, Tier::kModal};

}  // namespace

TEST_CASE("multiply_adds_count_padded_products_and_aggregation") {
  const pack::LayerRecord plain = layer(9, 16, 0), with_self = layer(9, 3, 1);
  // 16 (4 9 + 7 16) products a node; x, h and y of 9 + 2 16 numbers an entry.
  CHECK(multiply_adds({&plain, 1}, 2, 4) == 2 * 16 * (4 * 9 + 7 * 16) + 4 * (9 + 16 + 2 * 16));
  CHECK(multiply_adds({&with_self, 1}, 2, 4) == 2 * 16 * (8 * 9 + 7 * 3) + 4 * (9 + 3 + 2 * 3));
}

TEST_CASE("tiers_ascend_and_errors_that_were_not_measured_stay_nan") {
  const TierWork one{.nodes = 40, .mode_floats = 5000, .network_multiply_adds = 1000000};
  const std::span work(&one, 1);
  const std::vector<pack::TierRecord> tiers = make_tiers(work);
  REQUIRE(tiers.size() == std::size(kAll));
  for (size_t t = 0; t < tiers.size(); ++t) CHECK(tiers[t].tier == static_cast<uint32_t>(kAll[t]));
  CHECK(tiers[0].cost_us == 0);
  CHECK(tiers[0].error_ratio == 1.0f);
  CHECK(std::isnan(tiers[1].error_mm));
  // 2e6 operations at 60 GFLOP/s on top of the modes under the network.
  CHECK(tiers[2].cost_us - tiers[3].cost_us == Approx(100.0 / 3));
  CHECK(tiers[3].cost_us > tiers[1].cost_us);
  for (const pack::TierRecord& tier : tiers) CHECK(std::isnan(tier.error_mm));
  CHECK(std::isnan(tiers[2].error_ratio));
}

TEST_CASE("without_a_network_there_is_no_tier_of_it") {
  const TierWork work{.nodes = 40, .mode_floats = 5000};
  const std::vector<pack::TierRecord> tiers = make_tiers({&work, 1});
  REQUIRE(tiers.size() == std::size(kAll) - 1);
  for (const pack::TierRecord& tier : tiers) CHECK(tier.tier != static_cast<uint32_t>(Tier::kNetwork));
}

TEST_CASE("every_level_has_its_own_tiers_and_a_coarser_one_costs_less") {
  const TierWork work[] = {{.nodes = 40, .mode_floats = 5000, .network_multiply_adds = 1000000},
                           {.nodes = 10, .mode_floats = 1200, .network_multiply_adds = 200000}};
  const std::vector<pack::TierRecord> tiers = make_tiers(work);
  REQUIRE(tiers.size() == std::size(kAll) + 2);
  for (size_t i = 1; i < tiers.size(); ++i) {
    if (tiers[i].level == 0) continue;
    CHECK(tiers[i].tier == tiers[i - 1].tier);
    CHECK(tiers[i].level == 1);
    CHECK(tiers[i].cost_us < tiers[i - 1].cost_us);
    CHECK(std::isnan(tiers[i].error_ratio));
  }
}

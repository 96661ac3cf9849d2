// levels.cpp  Control graphs of the creature: one pack holds them, tiers are measured on each, and changes
// between them do not jump.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "baker/common/files/read_file.hpp"
#include "baker/common/files/safetensors.hpp"
#include "baker/measure/closed_loop.hpp"
#include "character/output/read.hpp"
#include "tests/baker/programs/creature_hop.hpp"

using namespace sinew;
using namespace sinew::baker;
using namespace sinew::test;

namespace {

// 40 ticks, of the creature as crowds have it.
const CreatureHop& hop() {
  static const CreatureHop made({.name = "hop_of_levels", .source = __FILE__, .recipe = "tissue_crowd.json"});
  return made;
}

struct Way {
  Tier tier;
  uint32_t level;
};
constexpr Way kWays[] = {{Tier::kModal, 0},   {Tier::kModal, 1},   {Tier::kModal, 2},
                         {Tier::kNetwork, 0}, {Tier::kNetwork, 1}, {Tier::kNetwork, 2}};

using Surface = std::vector<float>;

// What the surface is displaced by, tick by tick, where one way is left for another at tick `change`.
std::vector<Surface> surfaces(const LoadedPack& pack, const TrueMotion& motion, const Way& from,
                              const Way& to, size_t change) {
  ClosedLoop loop(pack, motion);
  std::vector<Surface> out;
  for (size_t tick = 0; tick < motion.ticks(); ++tick) {
    const Way& way = tick < change ? from : to;
    loop.tick(way.tier, way.level);
    const uint32_t vertices = pack.view().character->vertex_count;
    Surface surface(size_t{3} * vertices);
    world::read_surface(loop.instance(),
                        {.space = Space::kBind, .capacity = vertices, .positions = {surface.data()}});
    out.push_back(surface);
  }
  return out;
}

double step(const std::vector<Surface>& of, size_t tick, size_t v) {
  const Surface &a = of[tick - 1], &b = of[tick];
  return std::hypot(double{b[v]} - double{a[v]}, double{b[v + 1]} - double{a[v + 1]},
                    double{b[v + 2]} - double{a[v + 2]});
}

// How much further a vertex moves in a tick after the change than in either way all along.
double largest_jump(const std::vector<Surface>& changes, const std::vector<Surface>& from,
                    const std::vector<Surface>& to, size_t change) {
  double worst = 0;
  for (size_t tick = change; tick < changes.size(); ++tick)
    for (size_t v = 0; v < changes[tick].size(); v += 3)
      worst = std::max(worst, step(changes, tick, v) - std::max(step(from, tick, v), step(to, tick, v)));
  return worst;
}

}  // namespace

// Errors of the first ticks are the tier's own: nothing is blended in from skinning.
TEST_CASE("a_closed_loop_begins_at_rest_in_the_tier_that_it_is_told") {
  const LoadedPack pack = LoadedPack::from_file(hop().pack);
  const TrueMotion motion(read_safetensors(hop().truth), pack.view());
  for (const Tier tier : {Tier::kModal, Tier::kNetwork}) {
    ClosedLoop loop(pack, motion);
    loop.tick(tier, 0);
    CHECK(loop.instance().state->tier == tier);
    CHECK(loop.instance().state->blend_ticks == world::kBlendInTicks);
    CHECK(loop.instance().state->tissue.network_begins == 0);
  }
}

// On its way up and as it lands, where flesh is thrown about most; 0.3 % of the height is the project's
// bound.
TEST_CASE("a_change_of_the_creature_s_level_moves_no_vertex_by_more_than_a_tier_of_it_does") {
  const LoadedPack pack = LoadedPack::from_file(hop().pack);
  REQUIRE(pack.view().level_count == 4);
  const TrueMotion motion(read_safetensors(hop().truth), pack.view());
  std::vector<std::vector<Surface>> all;
  for (const Way& way : kWays) all.push_back(surfaces(pack, motion, way, way, 0));
  double worst = 0;
  for (size_t f = 0; f < std::size(kWays); ++f)
    for (size_t t = 0; t < std::size(kWays); ++t)
      for (const size_t change : {12u, 20u})
        if (f != t)
          worst = std::max(worst, largest_jump(surfaces(pack, motion, kWays[f], kWays[t], change), all[f],
                                               all[t], change));
  const double height_m = double{pack.view().character->height_m};
  WARN("largest jump " << 100 * worst / height_m << " % of the height");
  CHECK(worst < 0.003 * height_m);
}

TEST_CASE("a_trade_measures_every_level_and_bakes_what_each_is_worth") {
  const std::string out = hop().folder.file("out");
  must(run_program({SINEW_TRADE, hop().pack, "--truth", hop().truth, "-o", out}));
  const nlohmann::json rows = nlohmann::json::parse(read_text(out + "/trade.json")).at("rows");
  // By its name, or what it begins with: regions that are left out stand in any order.
  const auto row = [&](const std::string& name) {
    for (const auto& each : rows)
      if (each.at("name") == name || (name.ends_with('*') && each.at("name").get<std::string>().starts_with(
                                                                 name.substr(0, name.size() - 1))))
        return each;
    FAIL("no row " + name);
    return nlohmann::json();
  };
  const auto ratio = [&](const std::string& name) { return row(name).at("ratio").get<double>(); };
  CHECK(row("modal on 10 nodes").at("level") == 2);
  CHECK(ratio("modal") < ratio("modal on 20 nodes"));
  CHECK(ratio("modal on 20 nodes") < ratio("modal on 10 nodes"));
  CHECK(ratio("modal on 10 nodes") < 0.3);
  const std::string less = "modal on 10 nodes without cheek*";
  CHECK(row(less).at("level") == 3);
  CHECK(ratio("modal on 10 nodes") < ratio(less));
  CHECK(ratio(less) < ratio("modal on 10 nodes") + 0.1);
  CHECK(ratio("network on 20 nodes") < ratio("modal on 20 nodes"));
  const LoadedPack baked = LoadedPack::from_file(out + "/c.sinew");
  const auto coarse = std::ranges::count_if(baked.view().tiers, [](const auto& t) { return t.level > 0; });
  CHECK(coarse >= 2);
  for (const pack::TierRecord& tier : baked.view().tiers)
    if (tier.tier == static_cast<uint32_t>(Tier::kModal) && tier.level == 2)
      CHECK(double{tier.error_ratio} == Approx(ratio("modal on 10 nodes")));
  CHECK(baked.view().level_count == 4);
}

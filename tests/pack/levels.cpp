// levels.cpp  Coarser control graphs beside the finest: cut out of the sections they share, and what of them
// is refused.
#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "baker/common/bad_input.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "baker/pack/pack_writer.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::pack;
using Catch::Contains;
using test::PackEditor;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const std::vector<std::byte>& levels_pack() {
  static const std::vector<std::byte> bytes = test::small_levels_pack();
  return bytes;
}

struct Damage {
  const char* words;
  std::function<void(PackEditor&)> apply;
};

template <class T, class Change>
std::function<void(PackEditor&)> change(SectionKind kind, size_t index, Change apply) {
  return [=](PackEditor& editor) { apply(editor.section<T>(kind)[index]); };
}

template <class T>
std::function<void(PackEditor&)> set(SectionKind kind, size_t index, T value) {
  return change<T>(kind, index, [=](T& element) { element = value; });
}

void check_refused(const std::vector<std::byte>& bytes, const std::vector<Damage>& damages) {
  for (const Damage& damage : damages) {
    INFO(damage.words);
    PackEditor editor(bytes);
    damage.apply(editor);
    editor.seal();
    PackView view;
    const Status status = editor.open(&view);
    CHECK(status.code == StatusCode::kCorrupt);
    CHECK_THAT(status.message, Contains(damage.words));
    CHECK(view.character == nullptr);
  }
}

}  // namespace

// The finest: three nodes and two; the coarser: the first two and the first.
TEST_CASE("levels_that_do_not_fit_are_refused_by_name") {
  using enum SectionKind;
  const auto character = [](uint32_t count) {
    return change<CharacterRecord>(kCharacter, 0, [=](auto& c) { c.coarser_count = count; });
  };
  const auto level = [](size_t index, auto apply) { return change<LevelRecord>(kLevels, index, apply); };
  check_refused(
      levels_pack(),
      {{"4 coarser LODs", character(4)},
       {"2 records for 0 coarser ones", character(0)},
       {"2 records for 2 coarser ones", character(2)},
       {"LOD 1: a section ends early", level(1, [](auto& l) { l.node_count = 4; })},
       {"LOD 1: a section ends early", level(1, [](auto& l) { l.carry_floats = ~uint64_t{0}; })},
       {"LOD 0: a section ends early", level(0, [](auto& l) { l.matrix_floats = ~uint64_t{0}; })},
       {"LOD 1: a section ends early", level(1, [](auto& l) { l.node_count = 0xffffffffu; })},
       {"a section holds more", level(1, [](auto& l) { l.spread_floats -= 16; })},
       {"a section holds more", level(1, [](auto& l) { l.node_count = 2; })},
       {"region 1: radius", change<RegionRecord>(kRegions, 3, [](auto& r) { r.radius_m = 0; })},
       {"region 1: held at node 1 of 1",
        change<RegionRecord>(kRegions, 3, [](auto& r) { r.anchor_node = 1; })},
       {"LOD 1: region 1 touches other things",
        change<RegionRecord>(kRegions, 3, [](auto& r) { r.touches_body = 1; })},
       {"region 0: vertex", set<uint32_t>(kRegionVertices, 0, 500u)},
       {"LOD 1: region 0 is held elsewhere",
        change<RegionRecord>(kRegions, 2, [](auto& r) { r.anchor_node = 0; })},
       {"LOD 1: node 1 is node 0 of the finer LOD", set<uint32_t>(kPicks, 1, 0u)},
       {"LOD 1: node 2 is node 5 of the finer LOD", set<uint32_t>(kPicks, 2, 5u)},
       {"LOD 1: node 1 is not where node 2", set<uint32_t>(kPicks, 1, 2u)},
       {"LOD 1: a weight of spread is not within", set<float>(kSpread, 1, kNan)},
       {"LOD 1: padding of spread", set<float>(kSpread, 3, 1.0f)},
       {"tier 3: LOD 2", change<TierRecord>(kTiers, 3, [](auto& t) { t.level = 2; })},
       {"tier 3: 4 at LOD 0 does not ascend", change<TierRecord>(kTiers, 3, [](auto& t) { t.level = 0; })}});
}

// Regions 0 and 1 of three levels: 3 and 2 nodes, 2 and 1, 2 and none.
TEST_CASE("a_coarser_level_may_leave_regions_out_and_the_finest_none") {
  PackEditor editor(test::small_left_out_pack());
  PackView view;
  REQUIRE(editor.open(&view).ok());
  REQUIRE(view.level_count == 3);
  const PackView less = at_level(view, 2);
  CHECK(less.nodes.size() == 2);
  CHECK(less.regions[1].node_count == 0);
  CHECK(less.regions[1].vertex_count == view.regions[1].vertex_count);
  using enum SectionKind;
  check_refused(test::small_left_out_pack(),
                {{"region 1: held at node 1 of 0",
                  change<RegionRecord>(kRegions, 5, [](auto& r) { r.anchor_node = 1; })},
                 {"region 1: nodes do not follow",
                  change<RegionRecord>(kRegions, 5, [](auto& r) { r.first_node = 1; })},
                 {"region 0: 5000 nodes, outside 0..4096",
                  change<RegionRecord>(kRegions, 4, [](auto& r) { r.node_count = 5000; })}});
}

TEST_CASE("spread_or_picks_without_levels_are_refused") {
  baker::PackWriter writer = baker::PackWriter::from_pack(test::small_weightless_pack());
  writer.section(SectionKind::kPicks, std::vector<uint32_t>{0});
  PackEditor editor(writer.finish());
  CHECK_THAT(editor.open().message, Contains("picks or spread without a coarser LOD"));
}

TEST_CASE("every_level_is_a_whole_control_graph_of_the_same_regions_and_modes") {
  PackEditor editor(levels_pack());
  PackView view;
  REQUIRE(editor.open(&view).ok());
  REQUIRE(view.level_count == 2);
  CHECK(view.nodes.size() == 5);
  const PackView coarse = at_level(view, 1);
  CHECK(coarse.nodes.size() == 3);
  CHECK(coarse.graph_rows.size() == 4);
  CHECK(coarse.graph_rows[3] == coarse.graph_columns.size());
  CHECK(std::ranges::equal(coarse.picks, std::vector<uint32_t>{0, 1, 3}));
  for (size_t n = 0; n < coarse.nodes.size(); ++n)
    CHECK(std::ranges::equal(coarse.nodes[n].position_m, view.nodes[coarse.picks[n]].position_m));
  for (size_t r = 0; r < 2; ++r) {
    CHECK(coarse.regions[r].vertex_count == view.regions[r].vertex_count);
    CHECK(coarse.region_modes[r].mode_count == view.region_modes[r].mode_count);
  }
  // A coarser node's weights where the finer nodes stand: all the same in this pack.
  CHECK(coarse.spread[0] == 0.5f);
  CHECK(coarse.spread[32] == 1.0f);
  CHECK(at_level(coarse, 0).nodes.size() == 5);
}

TEST_CASE("one_level_has_the_bytes_it_had_before_there_were_levels") {
  PackEditor editor(test::small_weightless_pack());
  for (const SectionKind kind : {SectionKind::kLevels, SectionKind::kPicks, SectionKind::kSpread})
    CHECK(editor.section<std::byte>(kind).empty());
  PackView view;
  REQUIRE(editor.open(&view).ok());
  CHECK(view.character->coarser_count == 0);
  CHECK(view.level_count == 1);
}

TEST_CASE("a_coarser_graph_that_is_no_part_of_the_finer_one_is_not_packed") {
  const baker::Character character = test::small_character();
  const baker::TissueLayout layout = test::small_layout(character);
  const auto refusal = [&](const std::function<void(baker::GraphLevel&)>& spoil) {
    std::vector<baker::GraphLevel> coarser = {test::small_coarser_level(layout)};
    spoil(coarser[0]);
    try {
      baker::pack_character(character, layout, test::small_modes(layout), nullptr, coarser);
    } catch (const baker::BadInput& error) {
      return std::string(error.what());
    }
    return std::string("packed");
  };
  CHECK_THAT(refusal([](auto& level) { level.layout.nodes[0].vertex = 7; }),
             Contains("vertex 7, where the finer one has none"));
  CHECK_THAT(refusal([](auto& level) { level.layout.regions.pop_back(); }), Contains("has other regions"));
  CHECK_THAT(refusal([](auto& level) { level.layout.regions[0].vertices.pop_back(); }),
             Contains("has other regions"));
  CHECK(refusal([](auto&) {}) == "packed");
}

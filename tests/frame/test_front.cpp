// test_front.cpp  Of an asset's tiers, those that are worth buying, in the order in which they are bought.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "schedule/front.hpp"
#include "tests/frame/crowd.hpp"

using namespace sinew;
using frame::Front;
using frame::Level;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

Front front_of(const std::vector<Level>& points, float publish_us = 0) {
  Front front;
  frame::make_front(points, publish_us, &front);
  return front;
}

}  // namespace

TEST_CASE("points_that_are_no_numbers_are_left_out") {
  const Front front = front_of({{.tier = Tier::kModal, .tick_us = kNan, .error = 0.1f},
                                {.tier = Tier::kModal, .tick_us = kInfinity, .error = 0.1f},
                                {.tier = Tier::kModal, .tick_us = -1, .error = 0.1f},
                                {.tier = Tier::kModal, .tick_us = 1, .error = kNan},
                                {.tier = Tier::kModal, .tick_us = 1, .error = -0.1f},
                                {.tier = Tier::kModal, .tick_us = 1, .error = 1},
                                {.tier = Tier::kExtrapolate, .tick_us = 1, .error = 0.5f}});
  CHECK(front.best() == 0);
  CHECK(front.levels[0].error == 1);
  CHECK(front_of({}).best() == 0);
}

TEST_CASE("more_points_than_a_front_holds_are_left_out") {
  std::vector<Level> points;
  for (int i = 0; i < 40; ++i)
    points.push_back({.tier = Tier::kModal,
                      .tick_us = 1 + static_cast<float>(i),
                      .error = 0.9f / (1 + static_cast<float>(i))});
  CHECK(front_of(points).count <= frame::kMostLevels);
}

TEST_CASE("usual_tiers_are_all_on_their_front") {
  const Front front = test::usual_front();
  REQUIRE(front.count == 4);
  CHECK(front.levels[1].graph == 1);
  CHECK(front.levels[2].tier == Tier::kModal);
  CHECK(front.levels[3].tier == Tier::kNetwork);
  CHECK(front.level_of(Tier::kModal, 0) == 2);
  CHECK(front.level_of(Tier::kExtrapolate, 0) == 0);
}

TEST_CASE("on_a_coarser_graph_a_tier_is_a_little_further_off_than_on_the_finest") {
  CHECK(frame::coarser_error(0.3f, 0) == 0.3f);
  for (uint32_t graph = 1; graph < 4; ++graph) {
    CHECK(frame::coarser_error(0.3f, graph) > frame::coarser_error(0.3f, graph - 1));
    CHECK(frame::coarser_error(0.3f, graph) < 0.6f);
  }
}

TEST_CASE("dearer_and_no_better_is_dropped") {
  const Front front = front_of({{.tier = Tier::kNetwork, .tick_us = 5, .error = 0.3f, .graph = 1},
                                {.tier = Tier::kModal, .tick_us = 4, .error = 0.3f},
                                {.tier = Tier::kNetwork, .tick_us = 6, .error = 0.3f}});
  REQUIRE(front.count == 2);
  CHECK(front.levels[1].tier == Tier::kModal);
}

// Publishing is paid with the first level, so that a cheap coarse graph may not be worth it.
TEST_CASE("what_the_first_level_pays_for_publishing_decides_whether_it_is_worth_it") {
  const std::vector<Level> points = {{.tier = Tier::kModal, .tick_us = 10, .error = 0.5f, .graph = 1},
                                     {.tier = Tier::kModal, .tick_us = 25, .error = 0.2f}};
  CHECK(front_of(points, 0).count == 3);
  const Front published = front_of(points, 40);
  REQUIRE(published.count == 2);
  CHECK(published.levels[1].tier == Tier::kModal);
  CHECK(published.step_us(1, 2) == 40 + 2 * 25);
}

TEST_CASE("worth_falls_from_level_to_level_and_no_point_lies_below_the_front") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> cost(0.5f, 100), error(0.02f, 0.98f);
  constexpr float kRounding = 1e-5f;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Level> points(8);
    for (Level& point : points)
      point = {.tier = Tier::kModal, .tick_us = cost(random), .error = error(random)};
    const float publish_us = cost(random) / 10;
    const Front front = front_of(points, publish_us);
    for (uint32_t k = 1; k < front.count; ++k) {
      CHECK(front.levels[k].error < front.levels[k - 1].error);
      if (k > 1) CHECK(front.worth[k] <= front.worth[k - 1] * (1 + kRounding));
    }
    const auto on_front = [&](float tick_us) {
      for (uint32_t k = 1; k < front.count; ++k) {
        if (tick_us <= front.levels[k].tick_us) {
          const float below = k > 1 ? front.levels[k - 1].tick_us : -publish_us;
          const float share = (tick_us - below) / (front.levels[k].tick_us - below);
          return front.levels[k - 1].error + share * (front.levels[k].error - front.levels[k - 1].error);
        }
      }
      return front.levels[front.best()].error;
    };
    for (const Level& point : points) CHECK(point.error >= on_front(point.tick_us) - 1e-4f);
  }
}

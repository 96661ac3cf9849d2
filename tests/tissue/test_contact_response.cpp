// test_contact_response.cpp  Nodes held off half-spaces: complementarity, and what a tick's state becomes.
#include "tissue/modes/contact_response.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

// Floats of the size of one, a few roundings; sweeps end where one changes no gap by more than 1e-4 of the
// deepest, and leave some times that.
constexpr float kFloat = 1e-5f, kSettled = 1e-3f;

// Three nodes in a row on two modes: together along x, and the middle against the others; and a rest of each
// node's own.
struct Row {
  static constexpr uint32_t kNodes = 3, kPadded = 16, kModes = 2, kPaddedModes = 16;
  static constexpr float kOwn = 0.01f;
  std::vector<pack::ModeRecord> modes = std::vector<pack::ModeRecord>(kModes);
  test::Floats shape{kModes * kPadded}, turn{kModes * kPadded}, response{9 * (kPadded + kPaddedModes)},
      project{9 * kPaddedModes}, scratch{kPadded + kPaddedModes}, answer{kPadded};
  std::vector<float> q = std::vector<float>(kModes), r = std::vector<float>(9), l = r, theta = r, u = r,
                     felt = r;
  float rest_gain = 0.5f, most_m = 100;

  Row() {
    const float along[kModes][kNodes] = {{1, 1, 1}, {-1, 2, -1}};
    for (uint32_t k = 0; k < kModes; ++k) {
      modes[k].gain = 0.1f * static_cast<float>(k + 1);
      for (uint32_t n = 0; n < kNodes; ++n) {
        shape[k * kPadded + 3 * n] = along[k][n];
        response[3 * n * (kPadded + kPaddedModes) + kPadded + k] = along[k][n];
      }
    }
    for (uint32_t i = 0; i < 9; ++i) response[i * (kPadded + kPaddedModes) + i] = kOwn;
  }
  tissue::ModalBase base() {
    return {modes,          kNodes, kPadded, kPaddedModes, shape.data(), turn.data(), response.data(),
            project.data(), 0,      0,       rest_gain};
  }
  void press(std::span<tissue::NodeContact> contacts) {
    tissue::press(base(), most_m, contacts, felt.data(), scratch.data(), answer.data(),
                  {q.data(), r.data(), l.data(), theta.data(), u.data()});
  }
  float gap(const tissue::NodeContact& c) const {
    float sum = c.gap_m;
    for (size_t k = 0; k < 3; ++k) sum += c.normal[k] * l[3 * c.node + k];
    return sum;
  }
};

tissue::NodeContact along_x(uint32_t node, float gap_m, float side = 1) {
  return {.node = node, .normal = {side, 0, 0}, .gap_m = gap_m};
}

}  // namespace

TEST_CASE("gaps_that_are_open_change_nothing") {
  Row row;
  tissue::NodeContact contacts[] = {along_x(0, 0), along_x(2, 0.3f)};
  row.press(contacts);
  row.press({});
  CHECK(row.q == std::vector<float>(2));
  CHECK(row.u == std::vector<float>(9));
}

TEST_CASE("each_contact_is_closed_and_pressed_or_open_and_free") {
  std::mt19937 random(1);
  for (int drawn = 0; drawn < 200; ++drawn) {
    Row row;
    const float gaps[] = {test::uniform(random, -1, 1), test::uniform(random, -1, 1),
                          test::uniform(random, -1, 1)};
    tissue::NodeContact contacts[] = {along_x(0, gaps[0]), along_x(1, gaps[1], -1), along_x(2, gaps[2])};
    row.press(contacts);
    for (const tissue::NodeContact& contact : contacts) {
      INFO("drawn " << drawn << " node " << contact.node << " gap " << contact.gap_m << " press "
                    << contact.press);
      CHECK(contact.press >= 0);
      CHECK(row.gap(contact) > -kSettled);
      if (contact.press > 0) CHECK(std::fabs(row.gap(contact)) < kSettled);
    }
  }
}

TEST_CASE("the_state_is_what_the_felt_push_would_have_made_it") {
  Row row;
  tissue::NodeContact contacts[] = {along_x(1, -0.2f)};
  row.press(contacts);
  const float press = contacts[0].press;
  // l = (gain_0 1 + gain_1 2 2 + rest_gain own) press, of the middle node.
  CHECK(press == Approx(0.2 / (0.1 + 0.2 * 4 + 0.5 * 0.01)).margin(kFloat));
  CHECK(row.q[0] == Approx(0.1 * press).margin(kFloat));
  CHECK(row.q[1] == Approx(0.2 * 2 * press).margin(kFloat));
  CHECK(row.r[3] == Approx(0.5 * 0.01 * press).margin(kFloat));
  CHECK(row.l[0] == Approx(0.1 * press - 0.4 * press).margin(kFloat));
  CHECK(row.u == row.l);
}

TEST_CASE("a_node_that_nothing_moves_is_left_where_it_is") {
  Row row;
  for (size_t i = 0; i < 9 * (Row::kPadded + Row::kPaddedModes); ++i) row.response[i] = 0;
  tissue::NodeContact contacts[] = {along_x(0, -1)};
  row.press(contacts);
  CHECK(row.l == std::vector<float>(9));
}

TEST_CASE("gaps_that_are_not_numbers_change_nothing") {
  Row row;
  tissue::NodeContact contacts[] = {along_x(0, NAN), along_x(1, NAN)};
  row.press(contacts);
  CHECK(row.l == std::vector<float>(9));
  tissue::NodeContact beside[] = {along_x(0, NAN), along_x(1, -0.2f)};
  row.press(beside);
  CHECK(std::ranges::all_of(row.l, [](float l) { return std::isfinite(l); }));
}

TEST_CASE("where_each_press_asks_for_more_of_the_others_none_moves_further_than_it_may") {
  Row row;
  row.most_m = 0.5f;
  // Node 1's answer to node 0 is thrice its own and the other way, and the reverse: presses that grow.
  const size_t pitch = Row::kPadded + Row::kPaddedModes;
  for (size_t i = 0; i < 9 * pitch; ++i) row.response[i] = 0;
  row.response[0] = row.response[3 * pitch + 3] = 1;
  row.response[3] = row.response[3 * pitch] = -3;
  tissue::NodeContact contacts[] = {along_x(0, -0.4f), along_x(1, -0.4f)};
  row.press(contacts);
  for (const float l : row.l) CHECK(std::fabs(l) <= 0.5f * (1 + kFloat));
  CHECK(*std::ranges::max_element(row.l, {}, [](float l) { return std::fabs(l); }) != 0);
}

TEST_CASE("between_walls_that_leave_no_room_a_node_moves_no_further_than_it_may") {
  Row row;
  row.most_m = 0.3f;
  tissue::NodeContact contacts[] = {along_x(0, -50), along_x(1, -50, -1), along_x(2, -50)};
  row.press(contacts);
  for (const float l : row.l) CHECK(std::fabs(l) <= 0.3f * (1 + kFloat));
}

// join_islands.cpp  Cards of hair are joined where they are closest, as if every two vertices were compared.
#include "baker/mesh/surface/join_islands.hpp"

#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace sinew::baker;

namespace {

// Triangles of 2 cm strewn over a metre, the numbers of their corners mixed.
Character cards(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> metre(0, 1);
  Character character;
  std::vector<int> mixed(static_cast<size_t>(3 * count));
  std::iota(mixed.begin(), mixed.end(), 0);
  std::ranges::shuffle(mixed, random);
  character.positions.resize(mixed.size());
  character.welded.resize(mixed.size());
  std::iota(character.welded.begin(), character.welded.end(), 0);
  for (size_t t = 0; t < static_cast<size_t>(count); ++t) {
    const Vector3 place(metre(random), metre(random), metre(random));
    const std::array<int, 3> face = {mixed[3 * t], mixed[3 * t + 1], mixed[3 * t + 2]};
    for (const int corner : face)
      character.positions[static_cast<size_t>(corner)] =
          place + 0.02 * Vector3(metre(random), metre(random), metre(random));
    character.triangles.push_back(face);
  }
  return character;
}

double length_m(const Character& character, int a, int b) {
  return (character.positions[static_cast<size_t>(a)] - character.positions[static_cast<size_t>(b)]).norm();
}

// Kruskal over all pairs of vertices of one label.
std::pair<size_t, double> count_and_length(const Character& character, const std::vector<int>& label,
                                           double most_gap_m) {
  std::vector<int> root(label.size());
  for (const auto& face : character.triangles)
    for (const int corner : face) root[static_cast<size_t>(corner)] = face[0];
  std::vector<std::tuple<double, int, int>> pairs;
  for (int a = 0; a < static_cast<int>(label.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(label.size()); ++b)
      if (label[static_cast<size_t>(a)] == label[static_cast<size_t>(b)] &&
          label[static_cast<size_t>(a)] >= 0)
        pairs.emplace_back(length_m(character, a, b), a, b);
  std::ranges::sort(pairs);
  std::pair<size_t, double> found = {0, 0};
  for (const auto& [gap_m, a, b] : pairs) {
    const int from = root[static_cast<size_t>(b)], to = root[static_cast<size_t>(a)];
    if (gap_m > most_gap_m || from == to) continue;
    std::ranges::replace(root, from, to);
    ++found.first, found.second += gap_m;
  }
  return found;
}

}  // namespace

TEST_CASE("islands_are_joined_by_the_fewest_and_shortest_links_of_their_label") {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const double most_gap_m : {0.03, 0.1, std::numeric_limits<double>::infinity()}) {
      INFO(seed << ", at most " << most_gap_m);
      const Character character = cards(120, seed);
      std::vector<int> label(character.positions.size());
      for (size_t t = 0; t < character.triangles.size(); ++t)
        for (const int corner : character.triangles[t])
          label[static_cast<size_t>(corner)] = static_cast<int>(t % 4) - 1;
      const Links links = island_links(character, find_surface(character), label, most_gap_m);
      double sum_m = 0;
      for (const auto& [a, b] : links) {
        CHECK(label[static_cast<size_t>(a)] == label[static_cast<size_t>(b)]);
        CHECK(label[static_cast<size_t>(a)] >= 0);
        sum_m += length_m(character, a, b);
      }
      const auto [count, shortest_m] = count_and_length(character, label, most_gap_m);
      CHECK(links.size() == count);
      CHECK(sum_m == Approx(shortest_m));
    }
}

TEST_CASE("islands_that_lie_on_each_other_are_joined_by_links_of_no_length") {
  Character character = cards(1, 1);
  for (int twin = 1; twin < 20; ++twin) {
    character.triangles.push_back({3 * twin, 3 * twin + 1, 3 * twin + 2});
    for (size_t k = 0; k < 3; ++k) {
      character.positions.push_back(character.positions[k]);
      character.welded.push_back(static_cast<int>(character.welded.size()));
    }
  }
  const std::vector<int> label(character.positions.size(), 0);
  const Links links = island_links(character, find_surface(character), label, 0);
  CHECK(links.size() == 19);
  for (const auto& [a, b] : links) CHECK(length_m(character, a, b) == 0);
}

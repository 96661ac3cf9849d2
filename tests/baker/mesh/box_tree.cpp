// box_tree.cpp  A tree finds the boxes that comparing with each of them finds.
#include "baker/mesh/surface/box_tree.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace sinew::baker;

TEST_CASE("a_tree_of_boxes_finds_all_that_are_within_reach_in_their_order") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> metre(0, 1);
  const auto place = [&] { return Vector3(metre(random), metre(random), metre(random)); };
  for (const int count : {0, 1, 5, 300}) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (int i = 0; i < count; ++i) boxes.emplace_back(Eigen::AlignedBox3d(place())).extend(place());
    if (count > 1) boxes.emplace_back();  // of nothing
    const BoxTree tree(boxes);
    std::vector<int> found, expected;
    for (int i = 0; i < 100; ++i) {
      const Vector3 point = 2 * place();
      const double reach_m = 0.5 * metre(random);
      expected.clear();
      for (size_t box = 0; box < boxes.size(); ++box)
        if (!boxes[box].isEmpty() && boxes[box].exteriorDistance(point) <= reach_m)
          expected.push_back(static_cast<int>(box));
      tree.find(point, reach_m, found);
      CHECK(found == expected);
    }
  }
}

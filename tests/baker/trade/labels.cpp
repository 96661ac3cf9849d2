// labels.cpp  Names in the picture of a front can be read.
#include "baker/trade/report/labels.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sinew::baker;
using Point = Eigen::Vector2f;

namespace {

const LabelBox kRoom{Point(120, 90), Point(1240, 690)};

// As dear tiers lie: close to each other, at the lower right, two of them on one place.
std::vector<Labelled> crowd() {
  std::vector<Labelled> out;
  for (int i = 0; i < 20; ++i) {
    const auto k = static_cast<float>(std::max(i, 1));
    out.push_back({{1230 - 30 * k, 660 - 180 * std::abs(std::sin(2.3f * k))}, {60 + 9 * k, 18}});
  }
  return out;
}

bool lies_on(const std::vector<Point>& line, const LabelBox& box) {
  for (size_t k = 1; k < line.size(); ++k)
    for (float share = 0; share <= 1; share += 1e-3f)
      if (box.contains(Point(line[k - 1] + share * (line[k] - line[k - 1])))) return true;
  return false;
}

}  // namespace

TEST_CASE("names_in_a_chart_overprint_no_dot_no_line_and_no_name_and_stay_inside_the_axes") {
  const std::vector<Labelled> all = crowd();
  const std::vector<Point> line = {{130, 100}, {700, 500}, {1200, 640}};
  const std::vector<LabelBox> boxes = place_labels(all, line, kRoom);
  REQUIRE(boxes.size() == all.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    INFO(i);
    REQUIRE(boxes[i].sizes().isApprox(all[i].size, 1e-3f));
    CHECK(kRoom.contains(boxes[i]));
    for (const Labelled& other : all) CHECK(boxes[i].exteriorDistance(other.dot) > kDotRadius);
    for (size_t j = 0; j < i; ++j) CHECK_FALSE(boxes[i].intersects(boxes[j]));
    CHECK_FALSE(lies_on(line, boxes[i]));
  }
}

TEST_CASE("a_name_with_room_around_stands_to_the_right_of_its_dot") {
  const Labelled label{{400, 300}, {100, 18}};
  const LabelBox box = place_labels({&label, 1}, {}, kRoom).front();
  CHECK(box.min().x() == Approx(412));
  CHECK(box.center().y() == Approx(300));
}

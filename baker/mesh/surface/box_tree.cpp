// box_tree.cpp  see box_tree.hpp.
#include "baker/mesh/surface/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace sinew::baker {
namespace {

constexpr int kFewBoxes = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Eigen::AlignedBox3d> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!boxes_.empty()) build(0, static_cast<int>(boxes_.size()));
}

int BoxTree::build(int first, int count) {
  const auto at = nodes_.size();
  nodes_.push_back({{}, first, count, 0});
  const auto begin = order_.begin() + first;
  for (auto i = begin; i < begin + count; ++i) nodes_[at].box.extend(boxes_[static_cast<size_t>(*i)]);
  if (count <= kFewBoxes) return static_cast<int>(at);
  Eigen::Index axis = 0;
  nodes_[at].box.sizes().maxCoeff(&axis);
  std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
    const auto place = [&](int box) { return boxes_[static_cast<size_t>(box)].center()[axis]; };
    return place(a) < place(b);
  });
  build(first, count / 2);
  const int second = build(first + count / 2, count - count / 2);
  nodes_[at].second = second;
  return static_cast<int>(at);
}

void BoxTree::find(const Vector3& point, double reach_m, std::vector<int>& found) const {
  found.clear();
  if (!nodes_.empty()) search(0, point, reach_m, found);
  std::ranges::sort(found);
}

void BoxTree::search(int at, const Vector3& point, double reach_m, std::vector<int>& found) const {
  const Node& node = nodes_[static_cast<size_t>(at)];
  if (node.box.exteriorDistance(point) > reach_m) return;
  if (node.second > 0) {
    search(at + 1, point, reach_m, found);
    search(node.second, point, reach_m, found);
    return;
  }
  for (int i = node.first; i < node.first + node.count; ++i) {
    const int box = order_[static_cast<size_t>(i)];
    if (boxes_[static_cast<size_t>(box)].exteriorDistance(point) <= reach_m) found.push_back(box);
  }
}

}  // namespace sinew::baker

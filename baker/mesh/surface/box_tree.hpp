// box_tree.hpp  Which of many boxes are near a point.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// A tree of boxes, split at the median. Building costs n log n, a query about log n and what it finds.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Eigen::AlignedBox3d> boxes);

  // Puts into `found` the numbers of the boxes within reach of the point, ascending.
  void find(const Vector3& point, double reach_m, std::vector<int>& found) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box = {};
    int first = 0, count = 0;  // of order_
    int second = 0;            // the other half's; the first one's follows its parent. 0: it has no halves
  };
  int build(int first, int count);
  void search(int at, const Vector3& point, double reach_m, std::vector<int>& found) const;

  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace sinew::baker
